// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "pfv/time_step.hpp"
#include "physics/time_step_limit.hpp"
#include "text/number_text.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace pfv {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double spectral_radius(const Eigen::Matrix3d& matrix) {
  return Eigen::EigenSolver<Eigen::Matrix3d>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::Matrix3d spring_along(const Eigen::Vector3d& normal, const ContactStiffness& stiffness) {
  const Eigen::Matrix3d along = normal * normal.transpose();
  return stiffness.normal * along +
         stiffness.tangential * (Eigen::Matrix3d::Identity() - along);
}

/// From one place to the nearest image of another.
Eigen::Vector3d nearest_image(Eigen::Vector3d way, const Container& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis]) {
      const double length = box.upper[axis] - box.lower[axis];
      way[axis] -= length * std::round(way[axis] / length);
    }
  return way;
}

/// A face that does not exist since the packing repeats across it.
bool is_periodic(const Container& container, const Surface& surface) {
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis] && surface.is_plane() && surface.normal[axis] != 0.0) return true;
  return false;
}

void check(const ContactStiffness& stiffness) {
  if (!(stiffness.normal > 0.0) || !std::isfinite(stiffness.normal))
    throw InputError("contact stiffness " + detail::number_text(stiffness.normal) +
                     " N/m: give a positive number");
  if (!(stiffness.tangential >= 0.0) || !std::isfinite(stiffness.tangential))
    throw InputError("tangential contact stiffness " + detail::number_text(stiffness.tangential) +
                     " N/m: give 0 or a positive number");
}

}  // namespace

double viscous_time_step(double mass, const Eigen::Matrix3d& viscosity) {
  const double largest = spectral_radius(viscosity);
  return largest > 0.0 ? 2.0 * mass / largest : infinite;
}

double contact_time_step(double mass, const Eigen::Matrix3d& stiffness) {
  const double largest = spectral_radius(stiffness);
  return largest > 0.0 ? std::sqrt(mass / largest) : infinite;
}

double estimated_time_step(double mass, double radius, double viscosity) {
  return mass / (400.0 * viscosity * radius);
}

ContactSprings::ContactSprings(const Packing& packing, const Container& box, ContactStiffness stiffness)
    : spheres_(packing.size()) {
  check(stiffness);
  if (!box.tilt.isZero(0.0))
    throw InputError("contacts across the sides of a tilted cell are not looked for: leave the contact stiffness away");
  const auto count = static_cast<int>(packing.size());
  const auto touch = [&](int a, int b) {
    const Eigen::Vector3d way = nearest_image(packing.positions.col(b) - packing.positions.col(a), box);
    const double distance = way.norm();
    if (distance > 0.0 && distance < packing.radii[a] + packing.radii[b])
      springs_.push_back({std::min(a, b), std::max(a, b), spring_along(way / distance, stiffness)});
  };
  std::vector<int> order(packing.size());
  std::iota(order.begin(), order.end(), 0);
  const auto left = [&](int k) { return packing.positions(0, k) - packing.radii[k]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return left(a) != left(b) ? left(a) < left(b) : a < b;
  });
  for (int i = 0; i < count; ++i) {
    const int a = order[i];
    const double right = packing.positions(0, a) + packing.radii[a];
    for (int j = i + 1; j < count && left(order[j]) < right; ++j) touch(a, order[j]);
    if (!box.periodic[0]) continue;
    // those at the lower end, whose images stand beyond the upper one
    const double beyond = right - (box.upper[0] - box.lower[0]);
    for (int j = 0; j < i && left(order[j]) < beyond; ++j)
      if (!(left(a) < packing.positions(0, order[j]) + packing.radii[order[j]])) touch(a, order[j]);
  }
  for (int k = 0; k < count; ++k)
    for (const ContainerFace& face : box.faces) {
      const Surface& surface = face.surface;
      if (is_periodic(box, surface) || !(surface.distance(packing.positions.col(k)) < packing.radii[k])) continue;
      springs_.push_back({k, -1, spring_along(surface.outward_at(packing.positions.col(k)), stiffness)});
    }
}

std::vector<Eigen::Matrix3d> ContactSprings::of_spheres() const {
  std::vector<Eigen::Matrix3d> result(spheres_, Eigen::Matrix3d::Zero());
  for (const Spring& spring : springs_) {
    result[spring.first] += spring.stiffness;
    if (spring.second >= 0) result[spring.second] += spring.stiffness;
  }
  return result;
}

double ContactSprings::time_step_limit(const Eigen::VectorXd& masses) const {
  if (masses.size() != spheres_)
    throw InputError("contacts: " + std::to_string(masses.size()) + " masses for " +
                     std::to_string(spheres_) + " spheres; give one a sphere");
  if (!(masses.array() > 0.0).all())
    throw InputError("contacts: a mass is not a positive number; give kg");
  const Eigen::RowVectorXd root = masses.array().rsqrt().transpose();
  const auto accelerations = [&](const Eigen::VectorXd& u) {
    const Eigen::Matrix3Xd x = (u.reshaped(3, spheres_).array().rowwise() * root.array()).matrix();
    Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, spheres_);
    for (const Spring& spring : springs_) {
      Eigen::Vector3d way = x.col(spring.first);
      if (spring.second >= 0) way -= x.col(spring.second);
      const Eigen::Vector3d pull = spring.stiffness * way;
      force.col(spring.first) += pull;
      if (spring.second >= 0) force.col(spring.second) -= pull;
    }
    force.array().rowwise() *= root.array();
    return Eigen::VectorXd(force.reshaped());
  };
  if (springs_.empty()) return infinite;
  return 2.0 / std::sqrt(largest_eigenvalue(accelerations, pseudo_random(3 * spheres_)));
}

}  // namespace pfv
