// SPDX-License-Identifier: GPL-3.0-or-later
// `couple_every`: at which steps the flow is solved, and what acts between.
#include "fix_pfv.h"

#include "atom.h"
#include "comm.h"
#include "fix_property_atom.h"
#include "update.h"

#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

/// Whether the interval is the flow's own choice.
bool FixPfv::adapts() const { return settings_.steps.couple_error.has_value(); }

/// Where the per-atom array has the radii at the last solve.
int FixPfv::column_of_radii() const { return ranks_.dealt.column + (comm->nprocs > 1 ? 1 : 0); }

PfvPresent FixPfv::look_around() const {
  std::vector<FixMeshSurface*> meshes = faces_.prescribed_meshes();
  for (FixMeshSurface* mesh : obstacles_.meshes())
    if (std::find(meshes.begin(), meshes.end(), mesh) == meshes.end()) meshes.push_back(mesh);
  return present_of(atom, groupbit, per_atom_->array_atom, column_of_radii(), meshes, world);
}

/// Of the fluid since the last solve, as a part of the larger: fix_modify before a run without a setup (`pre no`, `every`).
double FixPfv::change_of_viscosity() const {
  const double before = since_.viscosity, now = settings_.fluid.viscosity;
  return std::abs(now - before) / std::max(now, before);
}

/// Of one answer for all ranks, for what follows is collective: only where the flow is are the faces' places known.
bool FixPfv::solve_due() {
  if (change_of_viscosity() > 0.0) return true;
  if (!adapts()) return since_.steps >= settings_.steps.couple_every;
  const pfv::NextSolve& next = schedule_.next();
  if (since_.steps >= next.steps) return true;
  const double tolerance = *settings_.steps.couple_error;
  std::optional<pfv::Container> now;
  if (!settings_.bindings.empty()) now = current_container();
  const PfvPresent present = look_around();
  int due = 0;
  if (ranks_.is_first())
    due = (now && pfv::change_of_imposed_values(*now, container_) > tolerance) ||
          present.change_of_grains(since_.present) > tolerance ||
          present.meshes_have_jumped(since_.present, next, tolerance) ||
          (since_.steps >= 2 && next.has_jumped(present.motion, tolerance));
  MPI_Bcast(&due, 1, MPI_INT, 0, world);
  return due;
}

/// Whether boundaries, `imposed` by as much, grains or meshes are so much other than at the last solve that it tells
/// nothing of the next. At a setup meshes may not have been moved yet. One answer for all ranks.
bool FixPfv::has_jumped(const PfvPresent& present, double imposed) const {
  const double tolerance = *settings_.steps.couple_error;
  const bool ran = update->ntimestep > update->firststep + 1;
  int jumped = std::max(imposed, present.change_of_grains(since_.present)) > pfv::NextSolve::foreseen * tolerance ||
               (ran && present.meshes_have_jumped(since_.present, schedule_.next(), tolerance));
  MPI_Bcast(&jumped, 1, MPI_INT, 0, world);
  return jumped;
}

/// Decides on the next solve from the loads of this one, `steps` after the last, at which boundaries were other by
/// `imposed`; collective.
void FixPfv::plan_next_solve(int steps, double imposed) {
  const double on_meshes = faces_.largest_load();
  const PfvPresent present = look_around();
  const bool now = update->ntimestep > update->firststep && has_jumped(present, imposed);
  const bool jumped = now || since_.jumped;  // mean velocities have a part of a jump, the rest comes with the next solve
  since_.jumped = now && steps > 1;
  on_flow([&] {
    schedule_.take(*flow_, {grains_.packing(), grains_.masses(), faces_.pistons(), steps, update->dt, present.motion,
                            on_meshes, settings_.options.retriangulation_strain, &bodies_.rigid(), jumped});
  });
  schedule_.share(world);
  since_.present = present;
  for (int i = 0; i < atom->nlocal; ++i)
    per_atom_->array_atom[i][column_of_radii()] = (atom->mask[i] & groupbit) ? atom->radius[i] : 0.0;
}

}  // namespace LAMMPS_NS
