// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: the limit of the explicit coupling, and which coupling follows from it.
#include "fix_pfv.h"

#include "pfv/error.hpp"
#include "pfv/time_step.hpp"

#include "error.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace LAMMPS_NS {

namespace {

/// The cheaper of the two couplings that go beyond the limit, by what a step costs in solves of the
/// explicit coupling (doc/stability.md, costs): a stage is a solve and a product with S and S^T, about
/// 1.6 sqrt(R) of them a step; an implicit step is one solve with a denser factor, made anew `steps`
/// steps later. Beyond `largest` grains that factor takes more than about 1.5 GB.
pfv::CouplingChoice cheaper(double ratio, double steps, Eigen::Index grains) {
  constexpr double of_a_stage = 1.15, of_an_implicit_step = 8.0, of_its_factor = 800.0;
  constexpr Eigen::Index largest = 20000;
  const double staged = of_a_stage * 1.6 * std::sqrt(ratio);
  const double implicit = of_an_implicit_step + of_its_factor / steps;
  return grains <= largest && implicit < staged ? pfv::CouplingChoice::implicit : pfv::CouplingChoice::staged;
}

}  // namespace

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
  if (settings_.steps.coupling != pfv::CouplingChoice::automatic && !obstacle_.empty())
    stop(FLERR, obstacle_);
}

/// Whether the flow may have to know the forces that act beside its own.
bool FixPfv::needs_forces() const { return settings_.steps.coupling != pfv::CouplingChoice::explicit_step; }

double FixPfv::flow_step() const { return settings_.steps.couple_every * update->dt; }

double FixPfv::time_step_limit() { return flow_->time_step_limit(grains_.masses(), pistons_); }

/// Asked for each network, and for the first two steps of a run; rank 0.
void FixPfv::choose_coupling() {
  chosen_for_ = flow_->retriangulations();
  chosen_ = settings_.steps.coupling;
  if (settings_.steps.coupling != pfv::CouplingChoice::automatic) return;
  const double limit = time_step_limit();
  const double ratio = flow_step() / (settings_.steps.safety * limit);
  if (ratio > 1.0 && !obstacle_.empty()) {
    char text[120];
    std::snprintf(text, sizeof text, "the flow step of %g s is above the explicit limit of %g s: ",
                  flow_step(), limit);
    throw pfv::InputError(text + obstacle_);
  }
  constexpr double unknown = 100.0;  // steps, before the first one has been seen
  const double steps = strain_of_a_step_ > 0.0
                           ? settings_.options.retriangulation_strain / strain_of_a_step_
                           : unknown;
  if (!(ratio > 1.0))
    chosen_ = pfv::CouplingChoice::explicit_step;
  else if (settings_.options.shear_viscous)  // which have no implicit step
    chosen_ = pfv::CouplingChoice::staged;
  else
    chosen_ = cheaper(ratio, steps, grains_.masses().size());
}

void FixPfv::take_implicit(bool advance) {
  const pfv::Packing packing = grains_.packing();
  advance ? flow_->step_implicit(packing, elapsed_, dynamics())
          : flow_->evaluate_implicit(packing, flow_step(), dynamics());
}

void FixPfv::take_staged(bool advance) {
  const pfv::Packing packing = grains_.packing();
  advance ? flow_->step_staged(packing, elapsed_, dynamics())
          : flow_->evaluate_staged(packing, flow_step(), dynamics());
}

void FixPfv::step_flow() {
  const double before = flow_->strain();
  const std::int64_t network = flow_->retriangulations();
  switch (chosen_) {
    case pfv::CouplingChoice::staged: take_staged(true); break;
    case pfv::CouplingChoice::implicit: take_implicit(true); break;
    default: flow_->step(grains_.packing(), elapsed_);
  }
  if (settings_.steps.coupling != pfv::CouplingChoice::automatic) return;
  const bool kept = network == flow_->retriangulations();
  const bool first = strain_of_a_step_ == 0.0;
  strain_of_a_step_ = flow_->strain() - (kept ? before : 0.0);
  if (first || chosen_for_ != flow_->retriangulations()) choose_coupling();
}

/// The chosen coupling at the setup of a run. What an earlier run saw is forgotten, as it would be in one
/// that starts from a restart file.
void FixPfv::evaluate_flow() {
  strain_of_a_step_ = 0.0;
  choose_coupling();
  if (chosen_ == pfv::CouplingChoice::staged)
    take_staged(false);
  else if (chosen_ == pfv::CouplingChoice::implicit)
    take_implicit(false);
}

/// The papers' estimate pi rho d^2 / (1200 mu) of the grain that is worst off, s.
double FixPfv::estimated_limit() const {
  const Eigen::VectorXd& masses = grains_.masses();
  const auto radii = grains_.packing().radii;
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < masses.size(); ++k)
    smallest = std::min(
        smallest, pfv::estimated_time_step(masses[k], radii[k], settings_.fluid.viscosity));
  return smallest;
}

/// Says where the time step stands, at the beginning of a run; rank 0.
void FixPfv::check_time_step() {
  if (!settings_.steps.time_step_check && !needs_forces()) return;
  const double limit = time_step_limit();
  const double ratio = flow_step() / limit;
  const auto pistons = std::count_if(pistons_.begin(), pistons_.end(), [](const pfv::Piston& one) {
    return std::isfinite(one.mass);
  });
  char text[400];
  std::snprintf(text, sizeof text,
                "Fix pfv (id %s): limit of the explicit coupling %.4g s (papers' pi rho d^2/(1200 "
                "mu): %.4g s), flow step %.4g s, ratio %.4g, pistons %d, %s coupling, stages %d\n",
                id, limit, estimated_limit(), flow_step(), ratio, static_cast<int>(pistons),
                pfv::name_of(chosen_), flow_->stages());
  print(text);
  if (settings_.fluid.bulk_modulus && pistons > 0 && settings_.steps.couple_every > 1) {
    std::snprintf(text, sizeof text,
                  "Fix pfv (id %s): a compressible fluid whose pressure is held over %d steps drives a piston "
                  "(servo) on at any time step; use `couple_every 1` or `couple_every auto`",
                  id, settings_.steps.couple_every);
    error->warning(FLERR, text);
  }
  if (needs_forces() || ratio <= settings_.steps.safety) return;
  std::snprintf(text, sizeof text,
                "Fix pfv (id %s): the flow step of %.4g s is %.4g times the limit of the explicit "
                "coupling; grains will shake. Use a time step below %.3g s%s",
                id, flow_step(), ratio, settings_.steps.safety * limit / settings_.steps.couple_every,
                rigid_bodies_ ? " (rigid bodies have no other coupling)"
                              : ", `coupling staged` or `coupling implicit`");
  error->warning(FLERR, text);
}

}  // namespace LAMMPS_NS
