// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_schedule.h"

#include <cstdio>

namespace LAMMPS_NS {

void PfvSolveSchedule::begin_run() {
  next_ = {};
  if (plan_) plan_->restart();
}

void PfvSolveSchedule::take(pfv::FlowModel& flow, const pfv::SolvedInstant& now) {
  plan_->take(flow, now);
  next_ = plan_->next();
}

void PfvSolveSchedule::share(MPI_Comm world) {
  double told[] = {static_cast<double>(next_.steps), next_.offset, next_.sensitivity, next_.motion, next_.share};
  MPI_Bcast(told, 5, MPI_DOUBLE, 0, world);
  next_ = {static_cast<int>(told[0]), told[1], told[2], told[3], told[4]};
}

std::string PfvSolveSchedule::summary() const {
  if (!plan_) return {};
  char line[160], error[60] = "";
  // where each step was solved, no load was held that could have erred
  if (taken_.solves < taken_.steps) {
    const double percent = 100.0 * plan_->interval().largest_error();
    std::snprintf(error, sizeof error, percent < 99.5 ? ", estimated error %.2g %% of the load" : ", estimated error %.0f %% of the load",
                  percent);
  }
  std::snprintf(line, sizeof line, "couple_every auto: solved at %lld of %lld steps%s\n",
                static_cast<long long>(taken_.solves), static_cast<long long>(taken_.steps), error);
  return line;
}

}  // namespace LAMMPS_NS
