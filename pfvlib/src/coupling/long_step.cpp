// SPDX-License-Identifier: GPL-3.0-or-later
// What staged and implicit steps share: the motion that they integrate, and the lagged correction.
#include "coupling/flow_data.hpp"
#include "coupling/phase_clock.hpp"
#include "pfv/error.hpp"

#include <cmath>

namespace pfv {

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

/// Lets the memory of the last pressures begin where there is none: `solve` finds those of the step for
/// given ones in the correction.
void FlowData::find_lag(const std::function<void(const Eigen::VectorXd&)>& solve) {
  if (!lag.empty()) return;
  constexpr int sweeps = 3;
  solve(Eigen::VectorXd::Zero(built->network.pores()));
  Eigen::VectorXd found = relative_pressures;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    solve(found);
    found += lag.relaxation * (relative_pressures - found);
  }
  lag.start_from(found);
}

}  // namespace pfv
