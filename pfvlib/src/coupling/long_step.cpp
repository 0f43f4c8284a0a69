// SPDX-License-Identifier: GPL-3.0-or-later
// What staged and implicit steps share: the motion that they integrate.
#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"

#include <cmath>

namespace pfv {

void FlowData::refuse_geometric(Coupling coupling) const {
  if (coupling != Coupling::explicit_step && options.volume_rates == VolumeRates::geometric)
    throw InputError("geometric volume rates go with explicit steps alone: they feed some motions, which "
                     "long steps outgrow; take reciprocal ones");
}

void FlowData::check_dynamics(const GrainDynamics& grains, const Packing& packing) const {
  if (!options.forces)
    throw InputError("a staged or implicit step needs forces: switch Options::forces on");
  const Eigen::Index n = packing.size();
  if (grains.other_forces.cols() != n || grains.masses.size() != n)
    throw InputError("a staged or implicit step needs mass and other force of each of the " +
                     std::to_string(n) + " grains");
  if ((grains.other_torques.cols() != 0 && grains.other_torques.cols() != n) ||
      (grains.inertias.size() != 0 && grains.inertias.size() != n))
    throw InputError("a staged or implicit step takes an inertia and other torque for each of the " +
                     std::to_string(n) + " grains, or none");
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::string sphere = "sphere " + std::to_string(packing.ids[k]);
    if (!grains.other_forces.col(k).allFinite() ||
        (grains.other_torques.cols() > 0 && !grains.other_torques.col(k).allFinite()))
      throw InputError(sphere + ": its other force or torque is not finite; a staged or implicit step "
                                "needs it");
    if (!(grains.masses[k] > 0.0) || (grains.inertias.size() > 0 && !(grains.inertias[k] > 0.0)))
      throw InputError(sphere + ": its mass or inertia is not a positive number; give kg and kg m2");
  }
  for (const Face face : all_faces) {
    const Piston& piston = grains.pistons[static_cast<int>(face)];
    if (!(piston.mass > 0.0) || !std::isfinite(piston.other_force))
      throw InputError(std::string("piston ") + name_of(face) +
                       ": its mass must be > 0 (kg) and its other force finite (N)");
  }
}

/// Of the active grains and the faces, which yield along their axes alone; 0 for a prescribed velocity.
Matrix6Xd FlowData::yielding(const GrainDynamics& grains, double step) const {
  const std::vector<int>& columns = built->grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Matrix6Xd result = Matrix6Xd::Zero(6, count + 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = columns[i];
    const double inertia = grains.inertias.size() > 0
                               ? grains.inertias[k]
                               : inertia_of(grains.masses[k], built->grains.spheres.radii[i]);
    result.col(i).head<3>().setConstant(step / grains.masses[k]);
    result.col(i).tail<3>().setConstant(step / inertia);
  }
  for (int face = 0; face < 6; ++face)
    result(face / 2, count + face) = step / grains.pistons[face].mass;
  return result;
}

/// All loads on the active grains and the pistons but those of the pressures less their reference.
Loads FlowData::held_forces(const GrainDynamics& grains) {
  const std::vector<int>& columns = built->grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  const bool lifted = options.buoyancy && !fluid.gravity.isZero(0.0);
  Loads held = Loads::Zero(6, count + 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    held.col(i).head<3>() = grains.other_forces.col(columns[i]);
    if (grains.other_torques.cols() > 0)
      held.col(i).tail<3>() = grains.other_torques.col(columns[i]);
    if (lifted) held.col(i).head<3>() += buoyancy_of(static_cast<int>(i));
  }
  if (!box.pressure_gradient.isZero(0.0)) held += gradient_loads();
  for (const Face face : all_faces) {
    const int f = static_cast<int>(face);
    held.col(count + f).head<3>() =
        grains.pistons[f].other_force * Eigen::Vector3d::Unit(axis_of(face)) +
        reference * box.area(face) * outward_normal(face);
  }
  return held;
}

}  // namespace pfv
