// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/background_rebuild.hpp"
#include "step/built_network.hpp"
#include "step/face_jumps.hpp"
#include "step/grain_jumps.hpp"
#include "step/problem.hpp"
#include "step/solution.hpp"
#include "work/work_record.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace pfv {

/// The pore strain since a network was built (Options::strain_measure).
class PoreStrain {
 public:
  double value() const { return value_; }
  void restore(double value) { value_ = value; }
  /// Begins anew for a network whose grains had strained by `taken_over` when it was taken up.
  void begin(StrainMeasure measure, int pores, double taken_over);
  /// Adds the volume rates of a step, m³/s: max_i |dV_i/dt| dt / V_i (thesis eqs. 5.13-5.14), or of the mean.
  void add(const BuiltNetwork& built, const Solution& solution);
  /// The strain since `then`, a former state of this, where fluid flows as in the last solution.
  double since(const PoreStrain& then, const BuiltNetwork& built, const Solution& last) const;

 private:
  StrainMeasure measure_ = StrainMeasure::largest;
  double value_ = 0.0, taken_over_ = 0.0;
  Eigen::VectorXd volume_changes_;  ///< of the pores, m³; no entries unless the mean strain is wanted
};

/// What a network that has just been taken up replaces.
struct Replaced {
  std::unique_ptr<BuiltNetwork> network;  ///< null where nothing of it is wanted any more
  std::optional<Spheres> grains;          ///< of it; none before the first network
  bool moved_by_host = false;             ///< the host has asked for the new one
  double put = 0.0;                       ///< FaceJumps::volume_put since it was taken up, m³
};

/// The network in use: knows when it no longer matches the grains, and builds the next one, at once or in the
/// background.
class NetworkKeeper {
 public:
  /// Called for each network that is taken up.
  using TakenUp = std::function<void(Replaced&&)>;

  /// What a step wants of its network.
  struct Wanted {
    double step;        ///< s
    bool advance;       ///< only an advancing step begins a network in the background or takes it up, so that
                        ///< when that happens depends on nothing but the steps
    bool keep_former;   ///< pressures will be carried over
    const Solution& last;
  };

  /// The network of the grains as they are or, with rebuild_lag, as they were not long ago. Throws InputError,
  /// SolverError.
  BuiltNetwork& update(const Packing& packing, const Problem& problem, const Wanted& wanted,
                       WorkRecord& work, const TakenUp& taken_up);

  /// The next update builds anew. `by_host`: because it has moved grains or faces.
  void discard(bool by_host);
  /// Waits for the network that is built in the background, where there is one.
  void await_next() const {
    if (next_) next_->network.wait();
  }
  /// Takes in the strain of a step.
  void strain(const Solution& solution) { strain_.add(*built_, solution); }
  /// As after so many networks, the last of which the next update builds.
  void restore(double strain, std::int64_t rebuilds);

  bool has_network() const { return built_ != nullptr; }
  BuiltNetwork& network() const { return *built_; }
  double strain() const { return strain_.value(); }
  /// Networks after the first.
  std::int64_t rebuilds() const { return rebuilds_; }
  /// Spheres of the packing that the network was made from, with those left out.
  Eigen::Index packed() const { return static_cast<Eigen::Index>(ids_.size()); }

 private:
  struct Next {
    BackgroundRebuild network;
    int steps;            ///< until it is taken up
    PoreStrain begun_at;  ///< the strain when it was begun
  };

  BuiltNetwork& renew(const Packing& packing, const Problem& problem, const Wanted& wanted, WorkRecord& work,
                      const TakenUp& taken_up);
  bool has_jumped(const Problem& problem, const Wanted& wanted) const;
  bool grains_have_jumped(const Packing& packing, const Problem& problem, const Wanted& wanted) const;
  bool is_outdated(const Packing& packing, const Problem& problem);
  bool has_moved_far(const Packing& packing, const Problem& problem) const;
  void rebuild_now(const Packing& packing, const Problem& problem, const Wanted& wanted,
                   WorkRecord& work, const TakenUp& taken_up);
  void take_up_next(const Problem& problem, const Solution& last, WorkRecord& work,
                    const TakenUp& taken_up);
  void take_up(std::unique_ptr<BuiltNetwork> fresh, const Problem& problem, double strain,
               WorkRecord& work, const TakenUp& taken_up);

  std::unique_ptr<BuiltNetwork> built_;
  std::optional<Spheres> former_grains_;  ///< of the network before, until the next is taken up
  std::vector<std::int64_t> ids_;         ///< of the packing
  bool stale_ = true, moved_by_host_ = false, had_network_ = false;
  std::optional<Next> next_;
  PoreStrain strain_;
  FaceJumps jumps_;
  GrainJumps grain_jumps_;
  std::int64_t rebuilds_ = 0;
};

}  // namespace pfv
