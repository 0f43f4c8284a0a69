// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/bead_mobility.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace pfv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d bead_mobility(double one, double other, const Vector3d& apart) {
  const double r = apart.norm(), larger = std::max(one, other), difference = std::abs(one - other);
  if (r <= difference) return Matrix3d::Identity() / larger;
  const Matrix3d along = apart * apart.transpose() / (r * r);
  if (r > one + other) {
    const double squares = (one * one + other * other) / (r * r);
    return 0.75 / r * ((1.0 + squares / 3.0) * Matrix3d::Identity() + (1.0 - squares) * along);
  }
  const double d2 = difference * difference, r2 = r * r, r3 = r2 * r;
  const double across = (16.0 * r3 * (one + other) - std::pow(d2 + 3.0 * r2, 2)) / (32.0 * r3);
  return (across * Matrix3d::Identity() + 3.0 * std::pow(d2 - r2, 2) / (32.0 * r3) * along) / (one * other);
}

namespace {

Vector3d nearest_image(const Spheres& spheres, const Vector3d& apart) {
  const Lattice lattice = spheres.lattice();
  return apart - lattice.displacement(lattice.nearest(apart));
}

}  // namespace

std::vector<Matrix3d> drags_of_beads(const Spheres& spheres, const std::vector<int>& members) {
  constexpr double same = 1e-9;  // spheres that hide one another have one mobility
  const auto count = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd mobility(3 * count, 3 * count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      mobility.block<3, 3>(3 * i, 3 * j) = bead_mobility(
          spheres.radii[members[i]], spheres.radii[members[j]],
          nearest_image(spheres, spheres.centres.col(members[j]) - spheres.centres.col(members[i])));
  mobility.diagonal() *= 1.0 + same;
  const Eigen::MatrixX3d drags = mobility.ldlt().solve(Matrix3d::Identity().replicate(count, 1));
  std::vector<Matrix3d> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Matrix3d own = drags.middleRows<3>(3 * i);
    result.push_back(0.5 * (own + own.transpose()));
  }
  return result;
}

}  // namespace pfv
