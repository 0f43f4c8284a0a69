// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace pfv {

/// Share (m³) of each sphere of a rigid body in the volume of their union: the part in the sphere's power cell.
/// The shares add up to the exact volume of the union; a sphere that others cover has 0. `centres` (3 x N, m),
/// `radii` (N, m). Cost: a triangulation of the N spheres. Throws InputError where numbers are not finite
/// or a radius is not positive.
Eigen::VectorXd union_parts(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii);

/// The same, shifted among the spheres as little as makes the lift act at `centre` (m), the centre of
/// mass: sum_k V_k (x_k - centre) = 0 as far as the spheres span it, with the same sum of the V_k. A
/// homogeneous body in a fluid at rest then feels no torque. What spheres span is judged by their spread
/// in each direction: below some 3 % of the largest nothing is shifted along it.
Eigen::VectorXd displaced_volumes(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii,
                                  const Eigen::Vector3d& centre);

}  // namespace pfv
