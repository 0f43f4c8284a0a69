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

/// Largest eigenvalue of M^-1 S G^-1 S^T, 1/s (with geometric rates E in place of S^T). The operator is
/// similar to it and, but for those, symmetric.
double FlowData::largest_drag() {
  const int spheres = built->grains.spheres.size();
  if (built->unknowns.count == 0 || spheres == 0) return 0.0;
  const Eigen::VectorXd& masses = built->limit_masses;
  Matrix6Xd root = Matrix6Xd::Zero(6, spheres + 6);
  for (int i = 0; i < spheres; ++i) {
    const double mass = masses[built->grains.columns[i]];
    root.col(i).head<3>().setConstant(1.0 / std::sqrt(mass));
    root.col(i).tail<3>().setConstant(
        1.0 / std::sqrt(inertia_of(mass, built->grains.spheres.radii[i])));
  }
  for (int face = 0; face < 6; ++face)  // guided along its axis
    root(face / 2, spheres + face) = 1.0 / std::sqrt(masses[masses.size() - 6 + face]);
  Eigen::VectorXd opened;
  const auto drag = [&](const Eigen::VectorXd& u) {
    const Motion v = (u.reshaped(6, spheres + 6).array() * root.array()).matrix();
    rates_of(*built, v, *team, opened);
    const Loads load = loads_of(*built, homogeneous_pressures(*built, opened)) - shear_forces_of(v);
    return Eigen::VectorXd((load.array() * root.array()).matrix().reshaped());
  };
  return largest_eigenvalue(drag, 6 * (spheres + 6));
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
  make_force_matrices(*built, options, *team, counts);
  make_volume_rates(*built, options, *team, counts);
  built->time_step_limit = limit_of(largest_drag());
  return *built->time_step_limit;
}

}  // namespace pfv
