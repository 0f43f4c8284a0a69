// SPDX-License-Identifier: GPL-3.0-or-later
// How long a time step may be, and how far the stages of a longer one must reach.
#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"
#include "physics/time_step_limit.hpp"

#include <cmath>
#include <limits>

namespace pfv {

namespace {

double limit_of(double eigenvalue) {
  return eigenvalue > 0.0 ? 2.0 / eigenvalue : std::numeric_limits<double>::infinity();
}

}  // namespace

double FlowData::largest_drag(
    const std::function<Eigen::Matrix3Xd(const Eigen::VectorXd&)>& forces_of_pressures) {
  const int spheres = built->grains.spheres.size();
  if (built->unknowns.count == 0 || spheres == 0) return 0.0;
  make_volume_rates(*built);
  // similar to M^-1 F G^-1 E, and nearly symmetric
  const Eigen::VectorXd& masses = built->limit_masses;
  Eigen::RowVectorXd root(spheres + 6);
  for (int i = 0; i < spheres; ++i) root[i] = 1.0 / std::sqrt(masses[built->grains.columns[i]]);
  root.tail(6) = masses.tail(6).transpose().cwiseSqrt().cwiseInverse();
  const auto drag = [&](const Eigen::VectorXd& u) {
    const Eigen::Matrix3Xd v =
        (u.reshaped(3, spheres + 6).array().rowwise() * root.array()).matrix();
    const Eigen::VectorXd p =
        homogeneous_pressures(*built, volume_rates(*built->volume_rate_matrix, v));
    Eigen::Matrix3Xd force = forces_of_pressures(p) - shear_forces_of(v);
    force.array().rowwise() *= root.array();
    for (int face = 0; face < 6; ++face)  // guided along its axis
      for (int axis = 0; axis < 3; ++axis)
        if (axis != face / 2) force(axis, spheres + face) = 0.0;
    return Eigen::VectorXd(force.reshaped());
  };
  return largest_eigenvalue(drag, 3 * (spheres + 6));
}

double FlowData::time_step_limit(const Eigen::VectorXd& masses,
                                 const std::array<Piston, 6>& pistons) {
  const auto count = static_cast<Eigen::Index>(packing_ids.size());
  if (masses.size() != count)
    throw InputError("time step limit: " + std::to_string(masses.size()) + " masses for " +
                     std::to_string(count) + " spheres; give one a sphere");
  Eigen::VectorXd all(count + 6);
  all.head(count) = masses;
  for (int face = 0; face < 6; ++face) all[count + face] = pistons[face].mass;
  if (!(all.array() > 0.0).all())
    throw InputError("time step limit: a mass is not a positive number; give kg");
  if (built->time_step_limit && all == built->limit_masses) return *built->time_step_limit;
  built->limit_masses = all;
  built->stage_limit.reset();
  make_force_matrices(*built, options, *team, counts);
  built->time_step_limit = limit_of(
      largest_drag([&](const Eigen::VectorXd& p) { return forces_with_faces(*built, p); }));
  return *built->time_step_limit;
}

double FlowData::stage_limit() {
  if (!built->stage_limit) {
    make_energy_forces(*built);
    built->stage_limit = limit_of(
        largest_drag([&](const Eigen::VectorXd& p) { return multiply(*built->energy_forces, p); }));
  }
  return *built->stage_limit;
}

}  // namespace pfv
