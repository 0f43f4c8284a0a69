// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/union_parts.hpp"

#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/solid_union.hpp"

#include <Eigen/Eigenvalues>
#include <numeric>
#include <vector>

namespace pfv {

namespace {

void check(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii) {
  if (centres.cols() != radii.size())
    throw InputError("union of spheres: " + std::to_string(centres.cols()) + " centres and " +
                     std::to_string(radii.size()) + " radii; give one a sphere");
  if (!centres.allFinite() || !radii.allFinite() || !(radii.array() > 0.0).all())
    throw InputError("union of spheres: a centre is not finite or a radius not a positive number");
}

/// Those that are not within another of the same centre, which no triangulation could tell apart.
std::vector<int> distinct_spheres(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii) {
  std::vector<int> kept;
  for (int k = 0; k < radii.size(); ++k) {
    bool covered = false;
    for (int other = 0; other < radii.size() && !covered; ++other)
      covered = other != k && centres.col(other) == centres.col(k) &&
                (radii[other] > radii[k] || (radii[other] == radii[k] && other < k));
    if (!covered) kept.push_back(k);
  }
  return kept;
}

/// These spheres in a box that cuts none of them.
Spheres boxed(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii,
              const std::vector<int>& kept) {
  const double margin = radii.maxCoeff();
  const Eigen::Vector3d lower =
      (centres.rowwise() - radii.transpose()).rowwise().minCoeff().array() - margin;
  const Eigen::Vector3d upper =
      (centres.rowwise() + radii.transpose()).rowwise().maxCoeff().array() + margin;
  Spheres spheres;
  const auto count = static_cast<Eigen::Index>(kept.size());
  spheres.ids.resize(count);
  std::iota(spheres.ids.begin(), spheres.ids.end(), 1);
  spheres.centres = centres(Eigen::all, kept).colwise() - lower;
  spheres.radii = radii(kept);
  Box box;
  box.lower = lower;
  box.upper = upper;
  spheres.edges = upper - lower;
  spheres.walls = walls_of(box, lower);
  spheres.volume = spheres.edges.prod();
  return spheres;
}

}  // namespace

Eigen::VectorXd union_parts(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii) {
  check(centres, radii);
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(radii.size());
  if (radii.size() == 0) return volumes;
  const std::vector<int> kept = distinct_spheres(centres, radii);
  const Spheres spheres = boxed(centres, radii, kept);
  const PoreSpace space = build_network(spheres, Eigen::Vector3d::Zero());
  const std::vector<SolidUnion> parts = solid_parts(space.network, space.spheres, spheres);
  for (std::size_t k = 0; k < kept.size(); ++k) volumes[kept[k]] = parts[k].volume;
  return volumes;
}

Eigen::VectorXd displaced_volumes(const Eigen::Matrix3Xd& centres, const Eigen::VectorXd& radii,
                                  const Eigen::Vector3d& centre) {
  constexpr double thin = 1e-3;  // squared spread that counts, as a part of the largest
  Eigen::VectorXd volumes = union_parts(centres, radii);
  if (volumes.size() < 2) return volumes;
  const Eigen::Matrix3Xd arms = centres.colwise() - centres.rowwise().mean();
  const Eigen::Vector3d moment = (centres.colwise() - centre) * volumes;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(arms * arms.transpose());
  // the least shift with a given moment and no sum is a linear function of the place
  for (int axis = 0; axis < 3; ++axis) {
    const double square = spread.eigenvalues()[axis];
    if (!(square > thin * spread.eigenvalues()[2])) continue;
    const Eigen::Vector3d way = spread.eigenvectors().col(axis);
    volumes -= (way.dot(moment) / square) * (arms.transpose() * way);
  }
  return volumes;
}

}  // namespace pfv
