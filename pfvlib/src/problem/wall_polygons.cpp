// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/wall_polygons.hpp"

#include "geometry/pi.hpp"
#include "problem/container_geometry.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace pfv {

namespace {

constexpr int strips_around = 96;  // of a cylinder: its section's polygon has 0.07 % less area

/// A tilted periodic cell is the box sheared along its periodic axes.
std::vector<WallPolygon> polygons_of_box(const Container& container) {
  const Eigen::Vector3d edges = container.upper - container.lower;
  Eigen::Matrix3d sides = edges.asDiagonal();
  sides(0, 1) = container.tilt[0];
  sides(0, 2) = container.tilt[1];
  sides(1, 2) = container.tilt[2];
  std::vector<WallPolygon> polygons;
  for (int f = 0; f < container.face_count(); ++f) {
    const int axis = f / 2;
    if (container.periodic[axis]) continue;
    WallPolygon polygon{f, {}};
    for (const auto& [along, across] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Eigen::Vector3d place;
      place[axis] = f % 2;
      place[(axis + 1) % 3] = f % 2 == 1 ? along : across;
      place[(axis + 2) % 3] = f % 2 == 1 ? across : along;
      polygon.corners.push_back(container.lower + sides * place);
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

std::vector<WallPolygon> polygons_of_cylinder(const Container& container) {
  const int round = *cylinder_of(container);
  const auto ends = ends_of_cylinder(container);
  const Surface& shell = container.faces[round].surface;
  const Eigen::Vector3d first = shell.axis.unitOrthogonal(), second = shell.axis.cross(first);
  std::array<Polygon3, 2> rings;
  for (int end = 0; end < 2; ++end) {
    const Surface& plane = container.faces[ends[end]].surface;
    const Eigen::Vector3d centre = shell.point + plane.distance(shell.point) * plane.normal;
    for (int i = 0; i < strips_around; ++i) {
      const double angle = 2.0 * pi * i / strips_around;
      rings[end].push_back(centre + shell.radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
  }
  std::vector<WallPolygon> polygons;
  if (periodic_axis(container, ends[0]) < 0)
    polygons = {{ends[0], Polygon3(rings[0].rbegin(), rings[0].rend())}, {ends[1], rings[1]}};
  for (int i = 0; i < strips_around; ++i) {
    const int next = (i + 1) % strips_around;
    polygons.push_back({round, {rings[0][i], rings[0][next], rings[1][next], rings[1][i]}});
  }
  return polygons;
}

}  // namespace

std::vector<WallPolygon> wall_polygons(const Container& container) {
  if (container.is_box) return polygons_of_box(container);
  if (cylinder_of(container)) return polygons_of_cylinder(container);
  std::vector<WallPolygon> polygons;
  const std::vector<Polygon3> found = geometry_of(container, Eigen::Vector3d::Zero()).polygons;
  for (int f = 0; f < container.face_count(); ++f)
    if (found[f].size() > 2 && periodic_axis(container, f) < 0) polygons.push_back({f, found[f]});
  return polygons;
}

Eigen::Vector3d corner_of_planes(const Surface& a, const Surface& b, const Surface& c) {
  const Eigen::Vector3d bc = b.normal.cross(c.normal), ca = c.normal.cross(a.normal), ab = a.normal.cross(b.normal);
  const double determinant = a.normal.dot(bc);
  Eigen::Vector3d corner = (a.offset * bc + b.offset * ca + c.offset * ab) / determinant;
  for (int step = 0; step < 2 && std::abs(determinant) < 0.1; ++step)
    corner += (a.distance(corner) * bc + b.distance(corner) * ca + c.distance(corner) * ab) / determinant;
  return corner;
}

Polygon3 clip(const Polygon3& polygon, const Surface& plane) {
  Polygon3 result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = plane.distance(a), db = plane.distance(b);
    if (da >= 0.0) result.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) result.push_back(a + da / (da - db) * (b - a));
  }
  return result;
}

}  // namespace pfv
