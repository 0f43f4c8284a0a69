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

/// Of one answer for all ranks, for what follows is collective: only where the flow is are the faces' places known.
bool FixPfv::solve_due() {
  if (!adapts()) return since_.steps >= settings_.steps.couple_every;
  if (since_.steps >= schedule_.next().steps) return true;
  const double tolerance = *settings_.steps.couple_error;
  const pfv::Container now = settings_.bindings.empty() ? container_ : current_container();
  const double motion = since_.steps >= 2 ? gross_motion() : schedule_.next().motion;
  int due = 0;
  if (ranks_.is_first())
    due = (!settings_.bindings.empty() && pfv::imposed_values_differ(now, container_, tolerance)) ||
          schedule_.next().has_jumped(motion, tolerance);
  MPI_Bcast(&due, 1, MPI_INT, 0, world);
  return due;
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
  on_flow([&] {
    schedule_.take(*flow_, {grains_.packing(), grains_.masses(), faces_.pistons(), steps, update->dt, motion,
                           on_meshes, settings_.options.retriangulation_strain, &bodies_.rigid()});
  });
  schedule_.share(world);
}

}  // namespace LAMMPS_NS
