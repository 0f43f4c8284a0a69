// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/background_rebuild.hpp"

#include "coupling/phase_clock.hpp"
#include "pfv/error.hpp"

#include <string>
#include <system_error>
#include <utility>

namespace pfv {

namespace {

/// What the thread works on, its own copy.
struct Task {
  PackingArrays grains;
  Box box;
  Fluid fluid;
  Options options;
  double step;
  bool moving;

  BackgroundRebuild::Result operator()() const {
    const BackgroundWork background;
    BackgroundRebuild::Result result;
    {
      const PhaseClock total(result.seconds.total);
      const auto alone = std::make_shared<Team>();  // the other threads are those of the steps
      const BuildSettings settings{box, fluid, options, alone};
      const BuildCost cost{result.counts, result.seconds};
      result.network = derive_network(grains.view(), settings, cost);
      factor_pressures(*result.network, settings, step, cost);
      if (moving) {
        const PhaseClock clock(result.seconds.assemble);
        make_volume_rates(*result.network, options, *alone, result.counts);
      }
      if (options.forces) {
        const PhaseClock clock(result.seconds.forces);
        make_force_matrices(*result.network, options, *alone, result.counts);
      }
    }
    return result;
  }
};

}  // namespace

BackgroundRebuild::BackgroundRebuild(const Packing& packing, const BuildSettings& settings,
                                     double step, bool moving) {
  Task task{{packing.ids, packing.positions, packing.radii, Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0),
             Eigen::VectorXd()},
            settings.box,
            settings.fluid,
            settings.options,
            step,
            moving};
  try {
    result_ = std::async(std::launch::async, std::move(task));
  } catch (const std::system_error& error) {
    throw SolverError(std::string("no thread can be started to rebuild in the background: ") +
                      error.what() + "; set rebuild_lag to 0");
  }
}

std::unique_ptr<BuiltNetwork> BackgroundRebuild::take(BuildCost cost) {
  Result result = result_.get();
  Counts& counts = cost.counts;
  counts.triangulate += result.counts.triangulate;
  counts.order += result.counts.order;
  counts.factor += result.counts.factor;
  counts.force_matrix += result.counts.force_matrix;
  ++counts.background;
  Seconds& seconds = cost.seconds;
  seconds.triangulate += result.seconds.triangulate;
  seconds.throats += result.seconds.throats;
  seconds.assemble += result.seconds.assemble;
  seconds.order += result.seconds.order;
  seconds.factor += result.seconds.factor;
  seconds.forces += result.seconds.forces;
  seconds.total += result.seconds.total;
  return std::move(result.network);
}

}  // namespace pfv
