// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/implicit_step.hpp"

#include "pfv/error.hpp"
#include "solve/linear_solver.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"
#include "step/pressure_solve.hpp"
#include "step/solvability.hpp"
#include "work/phase_clock.hpp"

namespace pfv {

namespace {

/// How far into the step, from 1/2 to 1, the velocities lie that the pressures belong to. Those of its end,
/// 1, are right half a step later than the forces act, which are means over the step; those of its
/// middle let the fastest motions swing for ever. 2/3 leaves a third of that shift, halves these swings
/// from step to step. With torques it erred least in the force at 80 limits of the explicit coupling in a step:
/// by 0.6 %, where 0.52 erred by 0.9 % and 1 by 0.8 %.
constexpr double theta = 2.0 / 3.0;

}  // namespace

void ImplicitStep::check(const Problem& problem) const {
  check_long_step(problem, Coupling::implicit);
}

void ImplicitStep::forget_network() {
  factor_.reset();
  sheared_.forget_network();
}

void ImplicitStep::forget_factor() {
  if (factor_) factor_->yielding.resize(6, 0);
  sheared_.forget_factor();
}

double ImplicitStep::residual(const Solution& solution) const {
  return factor_ ? relative_residual(factor_->system.matrix, solution.unknown_pressures, solution.right_side)
                 : sheared_.residual();
}

/// Anew where theta dt or a mass has changed.
void ImplicitStep::factor(const StepTask& task, const Matrix6Xd& yielding) {
  const auto& [built, problem, packing, dynamics, work] = task;
  if (!factor_) factor_.emplace();
  const bool kept = factor_->yielding.cols() == yielding.cols() && factor_->yielding == yielding;
  if (factor_->solver && kept) return;
  const std::vector<int> old_pattern = factor_->system.matrix.column;
  {
    const PhaseClock clock(work.seconds.assemble);
    const ForceMatrix& forces = *built.operators.force_matrix;
    const RigidBodies* const bodies = bodies_of(built);
    factor_->system = assemble_implicit(built.kept.system, built.unknowns,
                                        bodies ? forces_on_bodies(forces, *bodies) : forces, built.bases, yielding);
  }
  const bool new_pattern = !factor_->solver || factor_->system.matrix.column != old_pattern;
  if (!factor_->solver) factor_->solver = make_solver(problem.options, problem.team);
  if (built.unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(work.seconds.order);
      factor_->solver->order(factor_->system.matrix, unknown_places(built));
      ++work.counts.order;
    }
    const PhaseClock clock(work.seconds.factor);
    try {
      factor_->solver->factor(factor_->system.matrix);
    } catch (const SolverError& error) {
      factor_.reset();
      throw too_far_apart(built, problem.fluid, error.what());
    }
    ++work.counts.factor;
  }
  factor_->yielding = yielding;
  factor_->loses_digits.reset();
}

/// What the box has grown by since the network was built would join all pores in the matrix; it is taken with
/// the velocities that the other forces give, and the rest, of second order in the growth, is left to the next
/// step.
void ImplicitStep::solve(const StepTask& task, const ForcedMotion& forced, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const Motion expected = forced.moved_by(pressure_loads(built, solution));  // by imposed pressures alone
  const double growth = rate_beyond(solution.growth, expected) + solution.debt_rate;
  const auto set_rates = [&, &built = built, &problem = problem](const Motion& motion) {
    rates_of(built, motion, *problem.team, solution.rates);
    spread_over_pores(growth, built.throats, solution.rates);
  };
  ++work.counts.volume_rate;
  set_rates(expected);
  solve_pressures(built, problem, *factor_->solver, work, solution);
  const auto follow = [&, &built = built] {
    solution.motion = forced.moved_by(pressure_loads(built, solution));
    set_rates(solution.motion);
  };
  follow();
  refine_pressures(built, problem, *factor_->solver, factor_->loses_digits, work, solution, follow);
  solution.unpaid = solution.dt * (rate_beyond(solution.growth, solution.motion) -
                                   rate_beyond(solution.growth, expected));
}

/// w(theta) = w + theta dt/m (held + S p) together with G p = Q - S^T w(theta), where w = v(n+1/2) is the
/// packing's and the host makes v(n+3/2) of the forces, so that w(theta) = w + theta (v(n+3/2) - w).
void ImplicitStep::find(const StepTask& task, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  check_dynamics(*dynamics, packing, problem.container);
  solution.implicit = true;
  set_motion(built, problem, packing, solution.motion);
  check_bodies(dynamics->bodies, built.grains.held);
  take_bodies(built, problem, dynamics->bodies);
  ForcedMotion forced{solution.motion, {}, yielding_of(built, problem, *dynamics, theta * solution.dt), bodies_of(built)};
  solution.moving = !at_rest(packing, problem.container, problem.options.torques) ||
                    (forced.yielding.array() > 0.0).any();
  refuse_undetermined(problem, solution.moving);
  make_force_matrices(built, problem, work.counts);
  make_volume_rates(built, problem, work.counts);
  const bool sheared = problem.options.shear_viscous;
  if (sheared)
    sheared_.factor(task, forced.yielding);
  else
    factor(task, forced.yielding);
  solution.relative_pressures.setZero(built.network.pores());
  impose(built, solution);
  forced.held = held_loads(task, solution);  // with the reference pressure just set
  if (sheared)
    sheared_.solve(task, forced, solution);
  else
    solve(task, forced, solution);
  refuse_isolated(built, solution, sheared ? sheared_.isolated() : factor_->system.isolated);
}

}  // namespace pfv
