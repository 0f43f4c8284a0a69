// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/coupling_choice.hpp"

#include "pfv/error.hpp"
#include "problem/solver_abilities.hpp"

#include <cmath>
#include <sstream>

namespace pfv {

namespace {

/// The cheaper of the two couplings that go beyond the limit, by what a step costs in solves of the
/// explicit coupling (doc/stability.md, costs): a stage is a solve and a product with S and S^T, about
/// 1.6 sqrt(R) of them a step; an implicit step is one solve with a denser factor, made anew `steps`
/// steps later. Beyond `largest` grains that factor takes more than about 1.5 GB: the spins that torques bring are
/// unknowns, too.
Coupling cheaper(double ratio, double steps, Eigen::Index grains, const Options& options) {
  constexpr double of_a_stage = 1.15, of_an_implicit_step = 6.0, of_its_factor = 500.0;
  const Eigen::Index largest = options.torques ? 12000 : 25000;
  const double staged = of_a_stage * 1.6 * std::sqrt(ratio);
  const double implicit = of_an_implicit_step + of_its_factor / steps;
  return grains <= largest && implicit < staged ? Coupling::implicit : Coupling::staged;
}

}  // namespace

void CouplingChoice::choose(double limit, double dt, const Step& step, const Options& options,
                            Eigen::Index grains, std::int64_t network) {
  network_ = network;
  const double ratio = dt / (step.safety * limit);
  if (ratio > 1.0 && !step.obstacle.empty()) {
    std::ostringstream text;
    text << "the flow step of " << dt << " s is above the explicit limit of " << limit
         << " s: " << step.obstacle;
    throw InputError(text.str());
  }
  constexpr double unknown = 100.0;  // steps, before the first one has been seen
  const double steps = strain_of_a_step_ > 0.0 ? options.retriangulation_strain / strain_of_a_step_
                                               : unknown;
  if (!(ratio > 1.0))
    chosen_ = Coupling::explicit_step;
  else if (!abilities_of(options.solver).implicit_steps)
    chosen_ = Coupling::staged;
  else
    chosen_ = cheaper(ratio, steps, grains, options);
}

bool CouplingChoice::is_due_after(double strain_of_the_step, std::int64_t network) {
  const bool first = strain_of_a_step_ == 0.0;
  strain_of_a_step_ = strain_of_the_step;
  return first || network != network_;
}

}  // namespace pfv
