// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/background_rebuild.hpp"

#include "pfv/error.hpp"
#include "step/operators.hpp"
#include "work/phase_clock.hpp"

#include <string>
#include <system_error>
#include <utility>

namespace pfv {

namespace {

/// What the thread works on, its own copy.
struct Task {
  PackingArrays grains;
  Container container;
  Fluid fluid;
  Options options;
  std::shared_ptr<const Ranks> ranks;  ///< apart from those of the steps
  double step;
  bool moving;

  BackgroundRebuild::Result operator()() const {
    const BackgroundWork background;
    BackgroundRebuild::Result result;
    {  // the clock stops before the result is handed over
      WorkRecord& work = result.work;
      const PhaseClock total(work.seconds.total);
      const auto alone = std::make_shared<Team>();  // the other threads are those of the steps
      const Problem problem{container, fluid, options, alone, ranks};
      result.network = derive_network(grains.view(), problem, work);
      factor_pressures(*result.network, problem, step, work);
      if (moving) {
        const PhaseClock clock(work.seconds.assemble);
        make_volume_rates(*result.network, problem, work.counts);
      }
      if (options.forces) {
        const PhaseClock clock(work.seconds.forces);
        make_force_matrices(*result.network, problem, work.counts);
      }
    }
    return result;
  }
};

}  // namespace

BackgroundRebuild::BackgroundRebuild(const Packing& packing, const Problem& problem, double step,
                                     bool moving)
    : ranks_(problem.ranks), beside_(ranks_ ? ranks_->beside() : nullptr) {
  Task task{{packing.ids, packing.positions, packing.radii, Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0),
             packing.displaced_volumes, packing.bodies},
            problem.container,
            problem.fluid,
            problem.options,
            beside_,
            step,
            moving};
  try {
    result_ = std::async(std::launch::async, std::move(task));
  } catch (const std::system_error& error) {
    throw SolverError(std::string("no thread can be started to rebuild in the background: ") +
                      error.what() + "; set rebuild_lag to 0");
  }
}

std::unique_ptr<BuiltNetwork> BackgroundRebuild::take(WorkRecord& work) {
  result_.wait();
  Result result;
  const auto get = [&] { result = result_.get(); };
  if (beside_ && beside_->failed_together()) ranks_->together(get);
  else get();
  add_background(work, result.work);
  return std::move(result.network);
}

}  // namespace pfv
