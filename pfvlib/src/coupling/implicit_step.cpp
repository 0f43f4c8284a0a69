// SPDX-License-Identifier: GPL-3.0-or-later
// A step in which pressures and velocities are found together.
#include "coupling/flow_data.hpp"
#include "coupling/phase_clock.hpp"
#include "pfv/error.hpp"

namespace pfv {

namespace {

/// How far into the step, from 1/2 to 1, the velocities lie that the pressures belong to. Those of its end,
/// 1, are right half a step later than the forces act, which are means over the step; those of its
/// middle let the fastest motions swing for ever. 2/3 leaves a third of that shift, halves these swings
/// from step to step. With torques it erred least in the force at 80 limits of the explicit coupling in a step:
/// by 0.6 %, where 0.52 erred by 0.9 % and 1 by 0.8 %.
constexpr double theta = 2.0 / 3.0;

}  // namespace

/// A = G + theta S^T (dt/m) S, factored anew where theta dt or a mass has changed.
void FlowData::factor_implicit(const Matrix6Xd& yielding) {
  if (!built->implicit) built->implicit.emplace();
  ImplicitFactor& implicit = *built->implicit;
  const bool kept = implicit.yielding.cols() == yielding.cols() && implicit.yielding == yielding;
  if (implicit.solver && kept) return;
  const std::vector<int> old_pattern = implicit.system.matrix.column;
  {
    const PhaseClock clock(seconds.assemble);
    implicit.system = assemble_implicit(built->system, built->unknowns, *built->force_matrix,
                                        built->bases, yielding);
  }
  const bool new_pattern = !implicit.solver || implicit.system.matrix.column != old_pattern;
  if (!implicit.solver)
    implicit.solver = make_solver(options, team);
  if (built->unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(seconds.order);
      implicit.solver->order(implicit.system.matrix, unknown_places(*built));
      ++counts.order;
    }
    const PhaseClock clock(seconds.factor);
    try {
      implicit.solver->factor(implicit.system.matrix);
    } catch (const SolverError& error) {
      built->implicit.reset();
      throw too_far_apart(*built, fluid, error.what());
    }
    ++counts.factor;
  }
  implicit.yielding = yielding;
  implicit.loses_digits.reset();
}

/// The theta method in the drag: w(theta) = w + theta dt/m (held + S p) together with G p = Q - S^T w(theta),
/// where w = v(n+1/2) is the packing's and the host makes v(n+3/2) of the forces, so that
/// w(theta) = w + theta (v(n+3/2) - w). What the box has grown by since the network was built would join
/// all pores in the matrix; it is taken with the velocities that the other forces give, and the rest, of
/// second order in the growth, is left to the next step.
void FlowData::run_implicit(const Packing& packing, double step, double at_time,
                            const GrainDynamics& grains) {
  check_dynamics(grains, packing);
  set_motion(packing);
  ForcedMotion forced{motion, {}, yielding(grains, theta * step)};
  moving = !at_rest(packing, box, options.torques) || (forced.yielding.array() > 0.0).any();
  refuse_undetermined(moving);
  make_force_matrices(*built, options, *team, counts);
  make_volume_rates(*built, options, *team, counts);
  factor_implicit(forced.yielding);
  relative_pressures.setZero(built->network.pores());
  impose(at_time);
  forced.held = held_forces(grains);  // with the reference pressure just set
  const Motion expected = forced.moved_by(pressure_loads());  // by the imposed pressures alone
  const double growth = growth_beyond_rates(expected) + debt_rate;
  ++counts.volume_rate;
  rates_of(*built, expected, *team, rates);
  spread_over_pores(growth);
  solve_pressures(at_time, *built->implicit->solver);
  const auto follow = [&] {
    motion = forced.moved_by(pressure_loads());
    rates_of(*built, motion, *team, rates);
    spread_over_pores(growth);
  };
  follow();
  refine_pressures(*built->implicit->solver, built->implicit->loses_digits, follow);
  unpaid_growth = step * (growth_beyond_rates(motion) - growth_beyond_rates(expected));
  refuse_isolated(built->implicit->system.isolated);
}

}  // namespace pfv
