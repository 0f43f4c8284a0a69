// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: what the flow has to know of the grains for the coupling that is wanted.
#include "fix_pfv.h"

#include "pfv/time_step.hpp"

#include "error.h"
#include "update.h"

namespace LAMMPS_NS {

namespace {

pfv::Coupling in_library(PfvCoupling coupling) {
  switch (coupling) {
    case PfvCoupling::staged: return pfv::Coupling::staged;
    case PfvCoupling::implicit: return pfv::Coupling::implicit;
    case PfvCoupling::automatic: return pfv::Coupling::automatic;
    default: return pfv::Coupling::explicit_step;
  }
}

}  // namespace

void FixPfv::bind_coupling() {
  const PfvOtherFixes others(lmp, *this);
  groups_ = others.groups();
  rigid_bodies_ = others.rigid_bodies();
  obstacle_.clear();
  if (!needs_forces()) return;
  obstacle_ = settings_.couple_every > 1
                  ? "staged and implicit coupling need `couple_every 1`; they integrate the drag over "
                    "each step"
                  : others.obstacle_to_long_steps();
  if (settings_.coupling != PfvCoupling::automatic && !obstacle_.empty())
    stop(FLERR, obstacle_);
}

/// Whether the flow may have to know the forces that act beside its own.
bool FixPfv::needs_forces() const { return settings_.coupling != PfvCoupling::explicit_forces; }

double FixPfv::flow_step() const { return settings_.couple_every * update->dt; }

double FixPfv::time_step_limit() { return flow_->time_step_limit(grains_.masses(), pistons_); }

/// One call of the flow, over `dt` (s); rank 0.
void FixPfv::call_flow(double dt, bool commit) {
  const pfv::GrainDynamics dynamics =
      needs_forces() ? grains_.dynamics(pistons_) : pfv::GrainDynamics{};
  flow_->advance(grains_.packing(), dt,
                 {in_library(settings_.coupling), needs_forces() ? &dynamics : nullptr, commit,
                  settings_.safety, obstacle_});
}

/// Says where the time step stands, at the beginning of a run; rank 0.
void FixPfv::check_time_step() {
  if (!settings_.time_step_check && !needs_forces()) return;
  const pfv::TimeStepCheck check = pfv::check_time_step(*flow_, grains_.packing(), grains_.masses(),
                                                        pistons_, flow_step());
  const std::string head = std::string("Fix pfv (id ") + id + "): ";
  print(head + check.text() + "\n");
  const char* remedy = rigid_bodies_ ? " (rigid bodies have no other coupling)"
                                     : ", `coupling staged` or `coupling implicit`";
  for (const std::string& warning :
       pfv::warnings_of(check, settings_.couple_every, settings_.safety, remedy))
    error->warning(FLERR, (head + warning).c_str());
}

}  // namespace LAMMPS_NS
