// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: what the flow has to know of the grains for the coupling that is wanted.
#include "fix_pfv.h"

#include "pfv/error.hpp"
#include "pfv/time_step.hpp"

#include "error.h"
#include "update.h"

namespace LAMMPS_NS {

void FixPfv::bind_coupling() {
  others_ = PfvOtherFixes(lmp, *this).seen(needs_forces());
  if (needs_forces() && settings_.steps.couple_every > 1)
    others_.obstacle = "staged and implicit coupling need `couple_every 1`; they integrate the drag over each step";
  if (settings_.steps.coupling != pfv::Coupling::automatic && !others_.obstacle.empty())
    stop(FLERR, others_.obstacle);
}

/// Whether the flow may have to know the forces that act beside its own.
bool FixPfv::needs_forces() const { return settings_.steps.coupling != pfv::Coupling::explicit_step; }

double FixPfv::flow_step() const { return settings_.steps.couple_every * update->dt; }

/// One call of the flow, over `dt` (s); where the flow is.
void FixPfv::call_flow(double dt, bool commit) {
  const pfv::GrainDynamics dynamics =
      needs_forces() ? grains_.dynamics(faces_.pistons(), bodies_.rigid()) : pfv::GrainDynamics{};
  const std::string& obstacle = others_.obstacle.empty() && needs_forces() ? bodies_.obstacle() : others_.obstacle;
  if (settings_.steps.coupling != pfv::Coupling::automatic && !obstacle.empty()) throw pfv::InputError(obstacle);
  flow_->advance(grains_.packing(), dt,
                 {settings_.steps.coupling, needs_forces() ? &dynamics : nullptr, commit,
                  settings_.steps.safety, obstacle});
}

/// Where the time step stands now; its warnings, once a run. Where the flow is.
/// `reason`: what is known of it, for these.
pfv::TimeStepCheck FixPfv::look_at_time_step(const std::string& reason) {
  const pfv::TimeStepCheck check = pfv::check_time_step(*flow_, grains_.packing(), grains_.masses(),
                                                        faces_.pistons(), flow_step(), bodies_.rigid());
  said_.network = flow_->retriangulations();
  const std::string remedy = ", `coupling staged` or `coupling implicit`" + reason;
  const std::vector<std::string> warnings =
      pfv::warnings_of(check, settings_.steps.couple_every, settings_.steps.safety, remedy);
  if (!said_.time_step)
    for (const std::string& warning : warnings)
      warn_of(warning);
  said_.time_step = said_.time_step || !warnings.empty();
  return check;
}

/// At the beginning of a run; where the flow is.
void FixPfv::check_time_step() {
  said_.time_step = false;
  if (!settings_.steps.time_step_check && !needs_forces()) return;
  print("Fix pfv (id " + std::string(id) + "): " + units().relabelled(look_at_time_step().text()) + "\n");
}

/// Within a run: a packing that grows denser, or pores that close, bring the limit down. What one grain says of it is
/// asked of each network; where that warns, and now and then, the limit is found anew, at the cost of about a network.
/// Where the flow is.
void FixPfv::watch_time_step() {
  constexpr std::int64_t networks_between = 20;
  if (!settings_.steps.time_step_check || said_.time_step || settings_.model != pfv::Model::pores ||
      flow_->coupling() != pfv::Coupling::explicit_step || flow_->retriangulations() == said_.grain_network)
    return;
  said_.grain_network = flow_->retriangulations();
  const pfv::StiffestGrain grain = flow_->stiffest_grain(grains_.masses());
  const bool is_above = flow_step() > settings_.steps.safety * grain.limit;
  if (is_above || flow_->retriangulations() - said_.network >= networks_between)
    look_at_time_step(is_above ? "; it is the pores around grain " + std::to_string(grain.id) + " that ask for it" : "");
}

}  // namespace LAMMPS_NS
