// SPDX-License-Identifier: GPL-3.0-or-later
// `couple_every`: at which steps the flow is solved, and what acts between.
#include "fix_pfv.h"

#include "atom.h"
#include "update.h"

#include <mpi.h>
#include <cmath>

namespace LAMMPS_NS {

/// Whether the interval is the flow's own choice.
bool FixPfv::adapts() const { return settings_.steps.couple_error.has_value(); }

bool FixPfv::solve_due() {
  if (!adapts()) return since_.steps >= settings_.steps.couple_every;
  const double tolerance = *settings_.steps.couple_error;
  return since_.steps >= next_.steps ||
         (!settings_.bindings.empty() &&
          pfv::imposed_values_differ(current_container(), container_, tolerance)) ||
         (since_.steps >= 2 && next_.has_jumped(gross_motion(), tolerance));
}

/// Sum of |v| r² of the flow's grains, m³/s; collective.
double FixPfv::gross_motion() const {
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const double* v = atom->v[i];
      sum += std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * atom->radius[i] * atom->radius[i];
    }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

/// Decides on the next solve from the loads of this one, `steps` after the last; collective.
void FixPfv::plan_next_solve(int steps) {
  const double on_meshes = faces_.largest_load();
  const double motion = gross_motion();
  on_root([&] {
    plan_->take(*flow_, {grains_.packing(), grains_.masses(), pistons_, steps, update->dt, motion,
                         on_meshes, settings_.options.retriangulation_strain, &bodies_.rigid()});
    next_ = plan_->next();
  });
  double told[] = {static_cast<double>(next_.steps), next_.offset, next_.sensitivity, next_.motion};
  MPI_Bcast(told, 4, MPI_DOUBLE, 0, world);
  next_ = {static_cast<int>(told[0]), told[1], told[2], told[3]};
}

/// Steps from the instant that the loads of the last solve belong to until now; 0 where they are held.
double FixPfv::steps_of_trend() const {
  return adapts() && next_.steps > 1 ? next_.offset + since_.steps : 0.0;
}

}  // namespace LAMMPS_NS
