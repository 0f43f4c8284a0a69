// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"

#include <array>
#include <utility>

namespace pfv {

/// The facet opposite vertex i of a cell, spheres first; by the right-hand rule its normal points out
/// of the cell.
inline std::array<Vertex, 3> facet_opposite(const std::array<Vertex, 4>& cell, int i) {
  static constexpr int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::array<Vertex, 3> facet{cell[corners[i][0]], cell[corners[i][1]], cell[corners[i][2]]};
  // rotate walls to the end: a rotation keeps the orientation
  while (is_wall(facet[0]) || (is_wall(facet[1]) && !is_wall(facet[2])))
    facet = {facet[1], facet[2], facet[0]};
  return facet;
}

/// The same facet with its normal turned round; spheres stay first, and where all three are spheres the
/// first stays where it is.
inline std::array<Vertex, 3> reversed(std::array<Vertex, 3> facet) {
  const bool one_wall = is_wall(facet[2]) && !is_wall(facet[1]);
  std::swap(facet[1], facet[one_wall ? 0 : 2]);
  return facet;
}

/// Area vector (m²) of the facet's polygon: a triangle of centres; with one wall the trapezoid
/// between two centres and their projections; with two walls the rectangle between a centre and the
/// edge of the box. Its length is the area, its direction the facet's normal.
inline Eigen::Vector3d area_vector(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const int a = facet[0];
  const Eigen::Vector3d second = spheres.towards(a, facet[1]);
  const Eigen::Vector3d normal = second.cross(spheres.towards(a, facet[2]));
  if (!is_wall(facet[2])) return 0.5 * normal;
  const double height = spheres.distance(a, wall_number(facet[2]));
  if (!is_wall(facet[1]))
    return 0.5 * (height + spheres.distance(facet[1], wall_number(facet[2]))) * normal;
  return height * spheres.distance(a, wall_number(facet[1])) * normal;
}

/// Corners of the facet's polygon, counterclockwise about its normal.
struct FacetCorners {
  std::array<Eigen::Vector3d, 4> at;  ///< m
  int count = 3;
};
inline FacetCorners corners_of(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const auto on_wall = [&](const Eigen::Vector3d& from, int k, Vertex wall) -> Eigen::Vector3d {
    return from + spheres.distance(k, wall_number(wall)) * spheres.towards(k, wall);
  };
  const Eigen::Vector3d a = spheres.centres.col(facet[0]);
  if (!is_wall(facet[2]))
    return {{a, spheres.centres.col(facet[1]), spheres.centres.col(facet[2]), a}, 3};
  const Eigen::Vector3d last = on_wall(a, facet[0], facet[2]);
  if (is_wall(facet[1])) {
    const Eigen::Vector3d second = on_wall(a, facet[0], facet[1]);
    return {{a, second, second + last - a, last}, 4};
  }
  const Eigen::Vector3d b = spheres.centres.col(facet[1]);
  return {{a, b, on_wall(b, facet[1], facet[2]), last}, 4};
}

/// Integral of x cross n over a polygon, m³: the moment about the corner of the box of a unit pressure on it.
/// Over the facets and bases of a cell it adds up to zero.
inline Eigen::Vector3d moment_vector(const FacetCorners& polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& a = polygon.at[0];
  for (int i = 1; i + 1 < polygon.count; ++i) {
    const Eigen::Vector3d &b = polygon.at[i], &c = polygon.at[i + 1];
    sum += (a + b + c).cross((b - a).cross(c - a)) / 6.0;
  }
  return sum;
}

/// Unit normal of the facet; zero for a facet without area.
inline Eigen::Vector3d unit_normal(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const Eigen::Vector3d normal =
      spheres.towards(facet[0], facet[1]).cross(spheres.towards(facet[0], facet[2]));
  const double length = normal.norm();
  return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

}  // namespace pfv
