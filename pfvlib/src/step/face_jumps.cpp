// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/face_jumps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// How far places of a surface within `reach` of the middle have moved at most, m.
double way_between(const Surface& before, const Surface& now, const Eigen::Vector3d& middle, double reach) {
  if (now.is_plane())
    return std::abs(now.distance(middle) - before.distance(middle)) + reach * (now.normal - before.normal).norm();
  const Eigen::Vector3d shift = now.point - before.point;
  return std::abs(now.radius - before.radius) + now.axis.cross(shift).norm() +
         reach * (now.axis - before.axis).norm();
}

/// How far the face moves in that time at most, m.
double way_of(const ContainerFace& face, double time, const Eigen::Vector3d& middle, double reach) {
  const double turning = face.angular_velocity.norm();
  return std::abs(time) * (face.velocity.norm() + turning * (reach + (face.pivot - middle).norm()));
}

}  // namespace

void FaceJumps::begin(const Container& container, double step) {
  last_ = container;
  last_step_ = step;
  drifts_.assign(container.faces.size(), 0.0);
}

void FaceJumps::pass(const Container& container, double step) {
  const std::vector<double> ways = unexplained_ways(container, step);
  for (std::size_t f = 0; f < ways.size(); ++f) drifts_[f] += ways[f];
  last_ = container;
  last_step_ = step;
}

/// A host may move its faces before a step, by the velocities of this one, or after it, by those of the last.
std::vector<double> FaceJumps::unexplained_ways(const Container& container, double step) const {
  const Eigen::Vector3d middle = 0.5 * (last_.lower + last_.upper);
  const double reach = 0.5 * (last_.upper - last_.lower).norm();
  std::vector<double> ways(container.faces.size());
  for (std::size_t f = 0; f < ways.size(); ++f) {
    const ContainerFace &before = last_.faces[f], &now = container.faces[f];
    const double explained = way_of(before, last_step_, middle, reach) + way_of(now, step, middle, reach);
    ways[f] = std::max(0.0, way_between(before.surface, now.surface, middle, reach) - explained);
  }
  return ways;
}

bool FaceJumps::any(const Container& container, double step, double at_once, double in_all) const {
  if (container.faces.size() != last_.faces.size()) return true;
  const std::vector<double> ways = unexplained_ways(container, step);
  for (std::size_t f = 0; f < ways.size(); ++f)
    if (ways[f] > at_once || drifts_[f] + ways[f] > in_all) return true;
  return false;
}

}  // namespace pfv
