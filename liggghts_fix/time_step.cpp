// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: what the flow has to know of the grains for the coupling that is wanted.
#include "fix_pfv.h"

#include "pfv/time_step.hpp"

#include "error.h"
#include "update.h"

namespace LAMMPS_NS {

void FixPfv::bind_coupling() {
  const PfvOtherFixes others(lmp, *this);
  groups_ = others.groups();
  rigid_bodies_ = others.rigid_bodies();
  obstacle_.clear();
  if (!needs_forces()) return;
  obstacle_ = settings_.steps.couple_every > 1
                  ? "staged and implicit coupling need `couple_every 1`; they integrate the drag over "
                    "each step"
                  : others.obstacle_to_long_steps();
  if (settings_.steps.coupling != pfv::Coupling::automatic && !obstacle_.empty())
    stop(FLERR, obstacle_);
}

/// Whether the flow may have to know the forces that act beside its own.
bool FixPfv::needs_forces() const { return settings_.steps.coupling != pfv::Coupling::explicit_step; }

double FixPfv::flow_step() const { return settings_.steps.couple_every * update->dt; }

double FixPfv::time_step_limit() { return flow_->time_step_limit(grains_.masses(), pistons_); }

/// One call of the flow, over `dt` (s); rank 0.
void FixPfv::call_flow(double dt, bool commit) {
  const pfv::GrainDynamics dynamics =
      needs_forces() ? grains_.dynamics(pistons_) : pfv::GrainDynamics{};
  flow_->advance(grains_.packing(), dt,
                 {settings_.steps.coupling, needs_forces() ? &dynamics : nullptr, commit,
                  settings_.steps.safety, obstacle_});
}

/// Says where the time step stands, at the beginning of a run; rank 0.
void FixPfv::check_time_step() {
  if (!settings_.steps.time_step_check && !needs_forces()) return;
  const pfv::TimeStepCheck check = pfv::check_time_step(*flow_, grains_.packing(), grains_.masses(),
                                                        pistons_, flow_step());
  const std::string head = std::string("Fix pfv (id ") + id + "): ";
  print(head + check.text() + "\n");
  const char* remedy = rigid_bodies_ ? " (rigid bodies have no other coupling)"
                                     : ", `coupling staged` or `coupling implicit`";
  for (const std::string& warning :
       pfv::warnings_of(check, settings_.steps.couple_every, settings_.steps.safety, remedy))
    error->warning(FLERR, (head + warning).c_str());
}

}  // namespace LAMMPS_NS
