// SPDX-License-Identifier: GPL-3.0-or-later
// `couple_every`: how many steps apart the flow is solved, and how its loads go on between.
#ifndef LMP_PFV_SOLVE_SCHEDULE_H
#define LMP_PFV_SOLVE_SCHEDULE_H

#include "grain_exchange.h"
#include "history.h"
#include "periodic_cell.h"
#include "present.h"

#include "pfv/solve_plan.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mpi.h>
#include <optional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What has passed since the last solve, and where grains and faces were at it.
struct PfvSinceSolve {
  int steps = 0;
  double time = 0.0;                    // s
  std::vector<double> face_positions;
  std::vector<Eigen::Vector3d> pivots;  // of a container's faces
  PfvCellRates cell_rates{};            // of a periodic cell, over the interval that ended with it
  PfvSnapshot grains;                   // where the flow is
  PfvPresent present;                   // at it
  bool jumped = false;                  // in the interval of several steps that ended with it
  double viscosity = 0.0;               // of the fluid at it, Pa s
  std::optional<std::uint64_t> in_restart_file;  // fingerprint of what it was written with; none after a run
  bool from_older_file = false;         // without a fingerprint, and no run since
};

/// The steps from one solve to the next: always the same, or the flow's own choice within an error.
class PfvSolveSchedule {
 public:
  /// With a `tolerance` (of the load, 1 is all of it) the interval is the flow's own choice.
  void adapt_within(const std::optional<double>& tolerance) {
    if (tolerance) plan_.emplace(*tolerance);
  }

  /// The flow is on several ranks.
  void share_among(std::shared_ptr<const pfv::Ranks> ranks) {
    if (plan_) plan_.emplace(plan_->interval().tolerance(), std::move(ranks));
  }
  bool adapts() const { return plan_.has_value(); }
  void begin_run();
  void count_step() { ++taken_.steps; }
  void count_solve() { ++taken_.solves; }
  const PfvTaken& taken() const { return taken_; }
  void go_on_after(const PfvTaken& taken) { taken_ = taken; }

  /// Decides on the next solve from the loads of this one, where the flow is; then `share` with all.
  void take(pfv::FlowModel& flow, const pfv::SolvedInstant& now);
  void share(MPI_Comm world);

  /// Of grains that are dealt anew; see pfv::SolveInterval. No rows where nothing is remembered.
  Eigen::MatrixXd memory_of_grains(const pfv::Packing::Ids& ids) {
    return plan_ ? plan_->memory_of_grains(ids) : Eigen::MatrixXd(0, ids.size());
  }
  void remember_grains(const pfv::Packing::Ids& ids, const Eigen::MatrixXd& memory) {
    if (plan_) plan_->remember_grains(ids, memory);
  }

  const pfv::NextSolve& next() const { return next_; }
  /// Steps from the instant that the loads of the last solve belong to until now, `since` steps after it; 0 where
  /// they are held.
  double steps_of_trend(int since) const { return adapts() && next_.steps > 1 ? next_.offset + since : 0.0; }
  /// How loads go on between solves; null where they are held. Where the flow is.
  const pfv::HeldLoads* held() const { return plan_ ? &plan_->interval().held() : nullptr; }
  /// A line on all runs so far; empty where the interval was given. Where the flow is.
  std::string summary() const;

 private:
  std::optional<pfv::SolvePlan> plan_;  // in use where the flow is
  pfv::NextSolve next_;
  PfvTaken taken_;
};

}  // namespace LAMMPS_NS

#endif
