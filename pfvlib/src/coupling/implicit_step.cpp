// SPDX-License-Identifier: GPL-3.0-or-later
// A step in which pressures and velocities are found together.
#include "coupling/flow_data.hpp"
#include "coupling/phase_clock.hpp"

namespace pfv {

namespace {

/// With these 500 grains of size ratio 3, at a sixth of their contact limit, stay at rest in steps of any
/// number of limits; followed at once, the pressures shake them at 30.
constexpr double prompt_limits = 30.0;

/// How far into the step, from 1/2 to 1, the velocities lie that the pressures belong to. Those of its end,
/// 1, are right half a step later than the forces act, which are means over the step; those of its
/// middle let the fastest motions swing for ever. 2/3 leaves a third of that shift and halves these swings
/// from step to step; beyond some tens of limits the pressures change slowly, and it goes to 1.
double place_in_step(double relaxation) { return 1.0 - relaxation / 3.0; }

}  // namespace

/// A = G + E (theta dt/m) E^T, factored anew where theta dt or a mass has changed.
void FlowData::factor_implicit(const Eigen::RowVectorXd& per_mass) {
  make_energy_forces(*built);
  if (!built->implicit) built->implicit.emplace();
  ImplicitFactor& implicit = *built->implicit;
  const bool kept = implicit.yielding.size() == per_mass.size() && implicit.yielding == per_mass;
  if (implicit.solver && kept) return;
  const std::vector<int> old_pattern = implicit.system.matrix.column;
  {
    const PhaseClock clock(seconds.assemble);
    implicit.system = assemble_implicit(built->system, built->unknowns, *built->energy_forces,
                                        per_mass.transpose());
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
    implicit.solver->factor(implicit.system.matrix);
    ++counts.factor;
  }
  implicit.yielding = per_mass;
}

/// The theta method in the drag: w(theta) = w + theta dt/m (held + E^T p + (S - E^T) q) together with
/// G p = Q - E w(theta), where w = v(n+1/2) is the packing's and the host makes v(n+3/2) of the forces, so
/// that w(theta) = w + theta (v(n+3/2) - w). The part of S that is no transpose of E would make the matrix
/// unsymmetric; with the pressures q that the last ones lead one to expect it costs neither stability
/// nor order.
void FlowData::run_implicit(const Packing& packing, double step, double at_time,
                            const GrainDynamics& grains) {
  check_dynamics(grains, packing);
  moving = !at_rest(packing, box) || (yielding(grains, step).array() > 0.0).any();
  refuse_undetermined(moving);
  lag.relax(step / time_step_limit(grains.masses, grains.pistons), prompt_limits);
  const Eigen::RowVectorXd per_mass = yielding(grains, place_in_step(lag.relaxation) * step);
  make_force_matrices(*built, options, *team, counts);
  factor_implicit(per_mass);
  const Eigen::Matrix3Xd start = motion_of(packing);
  const auto velocities = [&](const Eigen::VectorXd& pressures, const Eigen::Matrix3Xd& others) {
    Eigen::Matrix3Xd change = multiply(*built->energy_forces, pressures) + others;
    change.array().rowwise() *= per_mass.array();
    return Eigen::Matrix3Xd(start + change);
  };
  relative_pressures.setZero(built->network.pores());
  impose(at_time);
  const Eigen::VectorXd imposed = relative_pressures;
  const Eigen::Matrix3Xd held = held_forces(grains);  // with the reference pressure just set
  const auto corrected = [&](const Eigen::VectorXd& expected) {
    return Eigen::Matrix3Xd(held + forces_with_faces(*built, expected) -
                            multiply(*built->energy_forces, expected));
  };
  const auto solve = [&](const Eigen::VectorXd& expected) {
    rates_of_motion(velocities(imposed, corrected(expected)));
    solve_pressures(at_time, *built->implicit->solver);
  };
  find_lag(solve);
  force_lag = lag.expected();
  solve(force_lag);
  mean_motion = velocities(relative_pressures, corrected(force_lag));
  rates_of_motion(mean_motion);
  refuse_isolated(built->implicit->system.isolated);
}

}  // namespace pfv
