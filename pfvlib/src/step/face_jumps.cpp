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

/// The face of a container, with its bounds where it is a box, as it stood before.
void put_back(Container& container, std::size_t face, const Surface& before) {
  Surface& now = container.faces[face].surface;
  if (container.is_box) {
    const Eigen::Vector3d way = (before.distance(container.lower) - now.distance(container.lower)) * now.normal;
    (now.normal.sum() > 0.0 ? container.upper : container.lower) += way;
  }
  now = before;
}

bool moves(const ContainerFace& face) {
  return !face.velocity.isZero(0.0) || !face.angular_velocity.isZero(0.0);
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
  for (std::size_t f = 0; f < ways.size(); ++f) {
    drifts_[f] += ways[f];
    moved_[f] = moved_[f] || moves(container.faces[f]);
  }
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

double FaceJumps::volume_put(const Container& container) {
  Container before = container;
  bool any = false;
  for (std::size_t f = 0; stood_.size() == container.faces.size() && f < stood_.size(); ++f)
    if (!moved_[f] && !moves(container.faces[f])) {
      any = any || way_between(stood_[f], container.faces[f].surface, container.lower, 0.0) > 0.0;
      put_back(before, f, stood_[f]);
    }
  stood_.clear();
  moved_.clear();
  for (const ContainerFace& face : container.faces) {
    stood_.push_back(face.surface);
    moved_.push_back(moves(face));
  }
  if (!any) return 0.0;
  find_bounds(before);
  return volume_of(container) - volume_of(before);
}

}  // namespace pfv
