// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/round_walls.hpp"
#include "network/spheres.hpp"
#include "problem/wall_polygons.hpp"

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

/// Two plane walls as sphere k sees them: distances u and v, cosine c between the outward normals, and the squared
/// sine. At right angles c is 0 and the sine 1, exactly.
struct WallPair {
  Eigen::Vector3d first, second, along;  ///< normals, and their cross product
  double u, v, c, sine2;
  /// From the foot on the first wall to the edge, along that wall, times the sine, m; negative where the foot lies
  /// beyond the edge: v - u c. And the same on the second.
  double leg, second_leg;
  bool narrow;  ///< nearly parallel, where that difference has lost its digits

  WallPair(int k, Vertex one, Vertex other, const Spheres& spheres)
      : first(spheres.outward(k, one)),
        second(spheres.outward(k, other)),
        along(first.cross(second)),
        u(spheres.distance(k, wall_number(one))),
        v(spheres.distance(k, wall_number(other))),
        c(first.dot(second)),
        sine2(along.squaredNorm()),
        leg(v - u * c),
        second_leg(u - v * c),
        narrow(sine2 < 0.01) {
    if (narrow) find_legs(spheres.centres.col(k), spheres.wall(one).surface.offset, spheres.wall(other).surface.offset);
  }
  /// From the sphere to the point of the edge that its plane across the edge meets.
  Eigen::Vector3d to_edge() const {
    return u * first + leg / sine2 * (narrow ? Eigen::Vector3d(along.cross(first)) : Eigen::Vector3d(second - c * first));
  }

 private:
  /// From one edge for all spheres, so that what they see of it adds up: first and second differ, but for their sign, by
  /// `apart`, which is exact, and 1 - |c| is half its square.
  void find_legs(const Eigen::Vector3d& centre, double offset, double second_offset) {
    const double same = c > 0.0 ? 1.0 : -1.0;
    const Eigen::Vector3d apart = same * second - first;
    along = 0.5 * same * (first + same * second).cross(apart);
    sine2 = along.squaredNorm();
    const double less = 0.5 * apart.squaredNorm();  // 1 - |c|
    leg = (second_offset - same * offset) + same * less * offset - along.cross(first).dot(centre);
    second_leg = (offset - same * second_offset) + same * less * second_offset - second.cross(along).dot(centre);
  }
};

/// Area vector (m²) of the facet's polygon: a triangle of centres; with one wall the trapezoid
/// between two centres and their feet on it; with two walls the kite between a centre, its feet and the edge. Its
/// length is the area; its direction is the facet's normal or, where a foot lies so far beyond the edge that more
/// of the kite is turned over than not, the opposite one.
inline Eigen::Vector3d area_vector(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const int a = facet[0];
  if (is_wall(facet[1])) {
    const WallPair walls(a, facet[1], facet[2], spheres);
    const double twice = walls.narrow ? walls.u * walls.leg + walls.v * walls.second_leg
                                      : 2.0 * walls.v * walls.u - walls.c * (walls.u * walls.u + walls.v * walls.v);
    return twice / (2.0 * walls.sine2) * walls.along;
  }
  if (is_swept(facet, spheres)) return swept_area(facet, spheres);
  const Eigen::Vector3d second = spheres.towards(a, facet[1]);
  const Eigen::Vector3d normal = second.cross(spheres.towards(a, facet[2]));
  if (!is_wall(facet[2])) return 0.5 * normal;
  const double height = spheres.distance(a, wall_number(facet[2]));
  return 0.5 * (height + spheres.distance(facet[1], wall_number(facet[2]))) * normal;
}

/// The point of a wall nearest to a sphere's centre.
inline Eigen::Vector3d foot_on(Vertex wall, int k, const Spheres& spheres) {
  return spheres.centres.col(k) + spheres.distance(k, wall_number(wall)) * spheres.outward(k, wall);
}

/// The point of a wall nearest to a place; exact for a plane normal to an axis.
inline Eigen::Vector3d put_on(const WallSurface& wall, Eigen::Vector3d place) {
  if (wall.axis >= 0) {
    place[wall.axis] = wall.upper ? wall.surface.offset : -wall.surface.offset;
    return place;
  }
  if (wall.is_plane()) return place + wall.surface.distance(place) * wall.surface.normal;
  const Eigen::Vector2d in = wall.in_section(place);
  const double rho = in.norm();
  if (!(rho > 0.0)) return place + wall.surface.radius * wall.first;
  return place + (wall.surface.radius - rho) / rho * (in.x() * wall.first + in.y() * wall.second);
}

/// The point where three plane walls meet.
inline Eigen::Vector3d corner_of_walls(Vertex first, Vertex second, Vertex third, const Spheres& spheres) {
  return corner_of_planes(spheres.wall(first).surface, spheres.wall(second).surface, spheres.wall(third).surface);
}

/// Corners of the facet's polygon, counterclockwise about its normal; of a swept facet those of the surface.
struct FacetCorners {
  std::array<Eigen::Vector3d, 4> at;  ///< m
  int count = 3;
};
inline FacetCorners corners_of(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const Eigen::Vector3d a = spheres.centres.col(facet[0]);
  if (!is_wall(facet[2]))
    return {{a, spheres.centres.col(facet[1]), spheres.centres.col(facet[2]), a}, 3};
  const Eigen::Vector3d last = foot_on(facet[2], facet[0], spheres);
  if (is_wall(facet[1])) {
    const Eigen::Vector3d second = foot_on(facet[1], facet[0], spheres);
    const WallPair walls(facet[0], facet[1], facet[2], spheres);
    const Eigen::Vector3d edge = walls.c == 0.0 ? Eigen::Vector3d(second + last - a) : Eigen::Vector3d(a + walls.to_edge());
    return {{a, second, edge, last}, 4};
  }
  const Eigen::Vector3d b = spheres.centres.col(facet[1]);
  return {{a, b, foot_on(facet[2], facet[1], spheres), last}, 4};
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

/// Unit normal of the facet, of a swept one its mean; zero for a facet without area.
inline Eigen::Vector3d unit_normal(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const Eigen::Vector3d normal =
      is_swept(facet, spheres)
          ? swept_area(facet, spheres)
          : Eigen::Vector3d(spheres.towards(facet[0], facet[1]).cross(spheres.towards(facet[0], facet[2])));
  const double length = normal.norm();
  return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

}  // namespace pfv
