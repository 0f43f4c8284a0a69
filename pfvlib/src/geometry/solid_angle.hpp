// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace pfv {

/// Signed solid angle (sr) of the triangle (a, b, c) seen from the origin; the sign is that of
/// det(a, b, c). Lengths do not matter, so a direction may stand for a point at infinity.
/// Van Oosterom & Strackee 1983, eq. 8.
inline double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(numerator, denominator);
}

}  // namespace pfv
