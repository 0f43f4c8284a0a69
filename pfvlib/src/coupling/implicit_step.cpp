// SPDX-License-Identifier: GPL-3.0-or-later
// A step in which pressures and velocities are found together.
#include "coupling/flow_data.hpp"
#include "coupling/phase_clock.hpp"

namespace pfv {

/// A = G + E (dt/m) E^T, factored anew where dt or a mass has changed.
void FlowData::factor_implicit(const Eigen::RowVectorXd& per_mass) {
  make_energy_forces(*built);
  if (!built->implicit) built->implicit.emplace();
  ImplicitFactor& implicit = *built->implicit;
  if (implicit.solver && implicit.yielding == per_mass) return;
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

/// Backward Euler in the drag: v(n+3/2) = w + dt/m (held + E^T p + (S - E^T) p_old) together with
/// G p = Q - E v(n+3/2), where w = v(n+1/2) is the packing's. The part of S that is no transpose of E
/// would make the matrix unsymmetric; of the last step's pressures it costs neither stability nor order.
void FlowData::run_implicit(const Packing& packing, double step, double at_time,
                            const GrainDynamics& grains) {
  check_dynamics(grains, packing);
  const Eigen::RowVectorXd per_mass = yielding(grains, step);
  moving = !at_rest(packing, box) || (per_mass.array() > 0.0).any();
  refuse_undetermined(moving);
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
  const auto corrected = [&](const Eigen::VectorXd& old) {
    return Eigen::Matrix3Xd(held + forces_with_faces(*built, old) -
                            multiply(*built->energy_forces, old));
  };
  const auto solve = [&](const Eigen::VectorXd& old) {
    rates_of_motion(velocities(imposed, corrected(old)));
    solve_pressures(at_time, *built->implicit->solver);
  };
  relaxation = relaxation_of(step / time_step_limit(grains.masses, grains.pistons));
  find_lag(solve);
  force_lag = lagged;
  solve(force_lag);
  mean_motion = velocities(relative_pressures, corrected(force_lag));
  rates_of_motion(mean_motion);
  refuse_isolated(built->implicit->system.isolated);
}

}  // namespace pfv
