// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/disc_parts.hpp"

#include "geometry/arctangent.hpp"
#include "geometry/disc_sections.hpp"
#include "network/facets.hpp"

#include <cmath>
#include <utility>

namespace pfv {

namespace {

/// The facet's polygon in its own plane, with sphere `facet[corner]` at the origin; counterclockwise.
struct FlatFacet {
  Eigen::Vector3d first, second;  ///< its axes
  Polygon polygon;
  std::array<Eigen::Vector2d, 2> others;  ///< the two other vertices: centres (spheres only)
};

FlatFacet flatten(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                  const Eigen::Vector3d& normal) {
  const Vertex next = facet[(corner + 1) % 3], previous = facet[(corner + 2) % 3];
  const int k = facet[corner];
  const Eigen::Vector3d first = spheres.towards(k, next).normalized();
  const Eigen::Vector3d second = normal.cross(first);
  const auto flat = [&](const Eigen::Vector3d& v) {
    return Eigen::Vector2d(first.dot(v), second.dot(v));
  };
  const auto reach = [&](int sphere, Vertex wall) -> Eigen::Vector3d {
    return spheres.distance(sphere, wall_number(wall)) * spheres.towards(sphere, wall);
  };
  const bool next_wall = is_wall(next), previous_wall = is_wall(previous);
  const Eigen::Vector3d to_next = next_wall ? reach(k, next) : spheres.towards(k, next);
  const Eigen::Vector3d to_previous =
      previous_wall ? reach(k, previous) : spheres.towards(k, previous);

  FlatFacet result{first, second, {}, {}};
  result.others = {flat(to_next), flat(to_previous)};
  result.polygon.add(Eigen::Vector2d::Zero());
  result.polygon.add(flat(to_next));
  if (next_wall && previous_wall) {
    const WallPair walls(k, next, previous, spheres);
    result.polygon.add(flat(walls.c == 0.0 ? Eigen::Vector3d(to_next + to_previous) : walls.to_edge()));
  }
  if (next_wall && !previous_wall)
    result.polygon.add(flat(to_previous + reach(previous, next)));
  if (!next_wall && previous_wall) result.polygon.add(flat(to_next + reach(next, previous)));
  result.polygon.add(flat(to_previous));
  return result;
}

/// True when disc k meets neither another disc of the facet nor a side that does not start at its
/// centre: its part of the facet is then a plain sector.
bool is_plain_sector(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                     double area) {
  const int k = facet[corner];
  const double radius = spheres.radii[k];
  const Vertex next = facet[(corner + 1) % 3], previous = facet[(corner + 2) % 3];
  for (const Vertex other : {next, previous}) {
    if (is_wall(other)) {
      if (spheres.distance(k, wall_number(other)) < radius) return false;
      continue;
    }
    const double reach = radius + spheres.radii[other];
    if (spheres.towards(k, other).squaredNorm() < reach * reach) return false;
  }
  if (is_wall(next) && is_wall(previous)) return true;
  if (is_wall(facet[2])) {  // trapezoid: the other sphere's plumb line is the opposite side
    const Vertex other = is_wall(next) ? previous : next;
    const Vertex wall = is_wall(next) ? next : previous;
    return spheres.towards(k, other).cross(spheres.towards(k, wall)).norm() >= radius;
  }
  const double opposite = (spheres.centres.col(next) - spheres.centres.col(previous)).norm();
  return 2.0 * area >= radius * opposite;
}

/// The moment of a sector between the directions u and v: r³/3 times the integral of the directions, which
/// is (u + v) tan(angle / 2) for unit ones.
Eigen::Vector3d moment_of_sector(const Eigen::Vector3d& u, const Eigen::Vector3d& v, double radius) {
  const double cosine = u.dot(v), sine = u.cross(v).norm();
  return radius * radius * radius / 3.0 * sine / (1.0 + cosine) * (u + v);
}

/// What lies beyond a chord at distance h along u, on the side of `inward`: half a segment.
Eigen::Vector3d moment_beyond_chord(const Eigen::Vector3d& u, const Eigen::Vector3d& inward,
                                    double radius, double h) {
  const double half2 = (radius - h) * (radius + h);
  const double along = half2 * std::sqrt(half2) / 3.0;
  const double across =
      (radius - h) * (radius - h) * (2.0 * radius + h) / 6.0;  // integral of (r² - x²)/2 from h to r
  return along * u + across * inward;
}

/// The moment of the part in a triangle, or false where `disc_part_of_triangle` knows no area either.
bool moment_in_triangle(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                        const Eigen::Vector3d& normal, double area, Eigen::Vector3d& moment) {
  const int k = facet[corner];
  const Vertex others[2] = {facet[(corner + 1) % 3], facet[(corner + 2) % 3]};
  const double radius = spheres.radii[k];
  if (2.0 * area < radius * (spheres.centres.col(others[1]) - spheres.centres.col(others[0])).norm())
    return false;
  const Eigen::Vector3d to[2] = {spheres.towards(k, others[0]), spheres.towards(k, others[1])};
  const double distance[2] = {to[0].norm(), to[1].norm()};
  if (!(distance[0] > 0.0 && distance[1] > 0.0)) return false;
  const Eigen::Vector3d u[2] = {to[0] / distance[0], to[1] / distance[1]};
  moment = moment_of_sector(u[0], u[1], radius);
  double cut_angle = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double r = spheres.radii[others[i]];
    if (distance[i] >= radius + r) continue;
    const double chord = 0.5 * (distance[i] + (radius - r) * (radius + r) / distance[i]);
    if (chord <= 0.0) return false;
    if (chord >= radius) continue;
    const Eigen::Vector3d inward = (i == 0 ? 1.0 : -1.0) * normal.cross(u[i]);
    moment -= moment_beyond_chord(u[i], inward, radius, chord);
    cut_angle += arctangent(std::sqrt((radius - chord) * (radius + chord)), chord);
  }
  return cut_angle == 0.0 || cut_angle <= arctangent(u[0].cross(u[1]).norm(), u[0].dot(u[1]));
}

}  // namespace

namespace {

/// A swept facet's normal at one of its spheres.
Eigen::Vector3d normal_at(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres) {
  const int k = facet[corner];
  return spheres.towards(k, facet[(corner + 1) % 3]).cross(spheres.towards(k, facet[(corner + 2) % 3])).normalized();
}

}  // namespace

DiscPart disc_part(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                   const Eigen::Vector3d& normal, double area) {
  const int k = facet[corner];
  const double radius = spheres.radii[k];
  if (is_plain_sector(facet, corner, spheres, area)) {
    const Eigen::Vector3d u = spheres.towards(k, facet[(corner + 1) % 3]);
    const Eigen::Vector3d v = spheres.towards(k, facet[(corner + 2) % 3]);
    return {0.5 * radius * radius * std::atan2(u.cross(v).norm(), u.dot(v)),
            moment_of_sector(u.normalized(), v.normalized(), radius)};
  }
  FlatFacet flat = flatten(facet, corner, spheres,
                           is_swept(facet, spheres) ? normal_at(facet, corner, spheres) : normal);
  for (int i = 0; i < 2; ++i) {
    const Vertex other = facet[(corner + 1 + i) % 3];
    if (is_wall(other)) continue;
    const double r = spheres.radii[other];
    const Eigen::Vector2d& centre = flat.others[i];
    flat.polygon = clip(flat.polygon, centre,
                        0.5 * (centre.squaredNorm() + (radius - r) * (radius + r)));
  }
  const Section section = section_in_disc(flat.polygon, radius);
  return {section.area, section.moment.x() * flat.first + section.moment.y() * flat.second};
}

Eigen::Vector3d disc_moment(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                            const Eigen::Vector3d& normal, double area) {
  Eigen::Vector3d moment;
  const bool triangle = !is_wall(facet[2]);  // walls come last
  if (triangle && moment_in_triangle(facet, corner, spheres, normal, area, moment)) return moment;
  return disc_part(facet, corner, spheres, normal, area).moment;
}

double disc_part_of_triangle(const std::array<Vertex, 3>& facet, int corner,
                             const Spheres& spheres, const FacetShape& shape) {
  const int next = (corner + 1) % 3, previous = (corner + 2) % 3;
  const double radius = spheres.radii[facet[corner]];
  if (2.0 * shape.area < radius * shape.side[next]) return -1.0;
  double part = 0.5 * radius * radius * shape.angle[corner], cut = 0.0;
  for (const auto& [other, distance] : {std::pair(next, shape.side[corner]),
                                        std::pair(previous, shape.side[previous])}) {
    const double r = spheres.radii[facet[other]];
    if (distance >= radius + r) continue;
    const double chord = 0.5 * (distance + (radius - r) * (radius + r) / distance);
    if (chord <= 0.0) return -1.0;
    if (chord >= radius) continue;
    const double half = std::sqrt((radius - chord) * (radius + chord));
    const double angle = arctangent(half, chord);
    part -= 0.5 * (radius * radius * angle - chord * half);
    cut += angle;
  }
  return cut <= shape.angle[corner] ? part : -1.0;
}

}  // namespace pfv
