// SPDX-License-Identifier: GPL-3.0-or-later
// A step in which pressures and velocities are found together, and what staged steps share with it.
#include "coupling/flow_data.hpp"
#include "coupling/phase_clock.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// Up to this many limits of the explicit coupling in a step the correction (S - E^T) p_old follows the
/// pressures at once. In a few motions the papers' S feeds energy to the grains, at a rate in proportion
/// to 1/limit, so that at many limits a step it outgrows the contacts that hide it. Followed more slowly,
/// the feeding is divided by what E^T damps in the meantime.
constexpr double prompt_limits = 30.0;

}  // namespace

void FlowData::check_dynamics(const GrainDynamics& grains, const Packing& packing) const {
  if (!options.forces)
    throw InputError("a staged or implicit step needs forces: switch Options::forces on");
  if (grains.other_forces.cols() != packing.size() || grains.masses.size() != packing.size())
    throw InputError("a staged or implicit step needs mass and other force of each of the " +
                     std::to_string(packing.size()) + " grains");
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const std::string sphere = "sphere " + std::to_string(packing.ids[k]);
    if (!grains.other_forces.col(k).allFinite())
      throw InputError(sphere + ": its other force is not finite; a staged or implicit step needs "
                                "it");
    if (!(grains.masses[k] > 0.0))
      throw InputError(sphere + ": its mass is not a positive number; give kg");
  }
  for (const Face face : all_faces) {
    const Piston& piston = grains.pistons[static_cast<int>(face)];
    if (!(piston.mass > 0.0) || !std::isfinite(piston.other_force))
      throw InputError(std::string("piston ") + name_of(face) +
                       ": its mass must be > 0 (kg) and its other force finite (N)");
  }
}

/// Velocities of the active grains and of the six faces.
Eigen::Matrix3Xd FlowData::motion_of(const Packing& packing) const {
  Eigen::Matrix3Xd of_grains;
  gather_velocities(packing, built->grains.columns, of_grains);
  return with_face_velocities(of_grains, box);
}

Eigen::Matrix3Xd FlowData::rated_motion() const {
  if (mean_motion.cols() > 0) return mean_motion;
  const auto spheres = static_cast<Eigen::Index>(built->grains.spheres.size());
  return moving ? with_face_velocities(velocities, solved_box)
                : Eigen::Matrix3Xd(Eigen::Matrix3Xd::Zero(3, spheres + 6));
}

void FlowData::rates_of_motion(const Eigen::Matrix3Xd& motion) {
  const PhaseClock clock(seconds.assemble);
  make_volume_rates(*built);
  ++counts.volume_rate;
  rates = volume_rates(*built->volume_rate_matrix, motion);
}

/// dt/m (s/kg) of the active grains and the six faces; 0 for a prescribed velocity.
Eigen::RowVectorXd FlowData::yielding(const GrainDynamics& grains, double step) const {
  const std::vector<int>& columns = built->grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::RowVectorXd per_mass(count + 6);
  for (Eigen::Index i = 0; i < count; ++i) per_mass[i] = step / grains.masses[columns[i]];
  for (int face = 0; face < 6; ++face) per_mass[count + face] = step / grains.pistons[face].mass;
  return per_mass;
}

/// All forces on the active grains and the pistons but those of the pressures less their reference.
Eigen::Matrix3Xd FlowData::held_forces(const GrainDynamics& grains) const {
  const std::vector<int>& columns = built->grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  const bool lifted = options.buoyancy && !fluid.gravity.isZero(0.0);
  Eigen::Matrix3Xd held = Eigen::Matrix3Xd::Zero(3, count + 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    held.col(i) = grains.other_forces.col(columns[i]);
    if (lifted) held.col(i) += buoyancy_of(static_cast<int>(i));
  }
  if (!box.pressure_gradient.isZero(0.0))
    held += gradient_forces(built->network, built->throats, built->viscous_shares,
                            static_cast<int>(count), {true, true},
                            box.pressure_gradient);
  for (const Face face : all_faces) {
    const int f = static_cast<int>(face), axis = axis_of(face);
    const Eigen::Vector3d edges = built->grains.spheres.edges;
    const double area = edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
    held.col(count + f) = grains.pistons[f].other_force * Eigen::Vector3d::Unit(axis) +
                          reference * area * outward_normal(face);
  }
  return held;
}

/// A = G + E (dt/m) E^T, factored anew where dt or a mass has changed.
void FlowData::factor_implicit(const Eigen::RowVectorXd& per_mass) {
  make_volume_rates(*built);
  if (!built->implicit) {
    built->implicit.emplace();
    built->implicit->energy_forces =
        energy_force_matrix(*built->volume_rate_matrix, built->grains.spheres.size());
  }
  ImplicitFactor& implicit = *built->implicit;
  if (implicit.solver && implicit.yielding == per_mass) return;
  const std::vector<int> old_pattern = implicit.system.matrix.column;
  {
    const PhaseClock clock(seconds.assemble);
    implicit.system = assemble_implicit(built->system, built->unknowns, implicit.energy_forces,
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
  relaxation =
      std::min(1.0, prompt_limits * time_step_limit(grains.masses, grains.pistons) / step);
  const ForceMatrix& energy_forces = built->implicit->energy_forces;
  const Eigen::Matrix3Xd start = motion_of(packing);
  const auto velocities = [&](const Eigen::VectorXd& pressures, const Eigen::Matrix3Xd& others) {
    Eigen::Matrix3Xd change = multiply(energy_forces, pressures) + others;
    change.array().rowwise() *= per_mass.array();
    return Eigen::Matrix3Xd(start + change);
  };
  relative_pressures.setZero(built->network.pores());
  impose(at_time);
  const Eigen::VectorXd imposed = relative_pressures;
  const Eigen::Matrix3Xd held = held_forces(grains);  // with the reference pressure just set
  const auto solve = [&](const Eigen::Matrix3Xd& others) {
    rates_of_motion(velocities(imposed, others));
    solve_pressures(at_time, *built->implicit->solver);
  };
  const auto corrected = [&](const Eigen::VectorXd& old) {
    return Eigen::Matrix3Xd(held + forces_with_faces(*built, old) - multiply(energy_forces, old));
  };
  if (lagged.size() == 0) {
    constexpr int sweeps = 3;
    solve(held);
    lagged = relative_pressures;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      solve(corrected(lagged));
      lagged += relaxation * (relative_pressures - lagged);
    }
  }
  force_lag = lagged;
  const Eigen::Matrix3Xd others = corrected(force_lag);
  solve(others);
  mean_motion = velocities(relative_pressures, others);
  rates_of_motion(mean_motion);
  refuse_isolated(built->implicit->system.isolated);
}

}  // namespace pfv
