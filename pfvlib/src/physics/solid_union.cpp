// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/solid_union.hpp"

#include "geometry/ball_sections.hpp"
#include "geometry/pi.hpp"
#include "geometry/solid_angle.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pfv {

namespace {

/// Orthonormal axes towards an edge, a facet and a cell that hold one sphere; false where they are
/// degenerate (the orthoscheme then has no volume).
bool add_axis(Eigen::Matrix3d& axes, int count, Eigen::Vector3d direction) {
  const double scale = direction.norm();
  for (int i = 0; i < count; ++i) direction -= axes.col(i).dot(direction) * axes.col(i);
  const double length = direction.norm();
  if (length <= 1e-14 * scale) return false;
  axes.col(count) = direction / length;
  return true;
}

/// Signed distance of sphere k's centre from the wall or from the radical plane it shares with `vertex`.
/// Not by way of the cells' centres: their rounding would put a centre on the plane on both sides of it.
double plane_distance(const Spheres& spheres, int k, Vertex vertex) {
  if (is_wall(vertex)) return spheres.distance(k, wall_number(vertex));
  const double r = spheres.radii[k], other = spheres.radii[vertex];
  const double distance = spheres.towards(k, vertex).norm();
  return 0.5 * (distance + (r - other) * (r + other) / distance);
}

/// What the plane shared with `cell[other]` takes from sphere `cell[corner]` within this cell.
BallSection cut_within_cell(const PoreNetwork& network, const Spheres& spheres, int c, int corner,
                            int other) {
  const auto& cell = network.cell_vertices[c];
  const int k = cell[corner];
  const Eigen::Vector3d centre = network.cell_centres.col(c) - spheres.centres.col(k);
  Eigen::Matrix3d axes;
  BallSection sum;
  if (!add_axis(axes, 0, spheres.towards(k, cell[other]))) return sum;
  const double a = plane_distance(spheres, k, cell[other]);
  if (std::abs(a) >= spheres.radii[k]) return sum;
  for (int third = 0; third < 4; ++third) {
    if (third == corner || third == other) continue;
    const int fourth = 6 - corner - other - third;
    if (!add_axis(axes, 1, spheres.towards(k, cell[third])) ||
        !add_axis(axes, 2, spheres.towards(k, cell[fourth])))
      continue;
    const double b = axes.col(1).dot(centre), d = axes.col(2).dot(centre);
    const double sign = (a < 0) ^ (b < 0) ^ (d < 0) ? -1.0 : 1.0;
    const BallSection cut =
        beyond_plane(spheres.radii[k], std::abs(a), std::abs(b), std::abs(d));
    sum.volume += sign * cut.volume;
    sum.area += sign * cut.area;
  }
  return sum;
}

/// Spheres whose centre is outside their own power cell.
std::vector<char> centres_outside(const PoreNetwork& network, const Spheres& vertices, int spheres) {
  std::vector<char> outside(spheres, 0);
  for (const auto& cell : network.cell_vertices)
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i)
      for (int j = 0; j < 4; ++j)
        if (i != j && plane_distance(vertices, cell[i], cell[j]) < 0.0) outside[network.vertex_sphere[cell[i]]] = 1;
  for (const int k : network.hidden) outside[k] = 1;
  return outside;
}

}  // namespace

std::vector<SolidUnion> solid_parts(const PoreNetwork& network, const Spheres& vertices,
                                    const Spheres& spheres) {
  std::vector<BallSection> cut(spheres.size());
  const std::vector<char> centre_outside = centres_outside(network, vertices, spheres.size());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i)
      for (int j = 0; j < 4; ++j) {
        if (i == j) continue;
        const int k = network.vertex_sphere[cell[i]];
        const BallSection section = cut_within_cell(network, vertices, c, i, j);
        cut[k].volume += section.volume;
        cut[k].area += section.area;
      }
  }
  std::vector<SolidUnion> parts(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) {
    const double r = spheres.radii[k];
    // the cones of the power cell's facets fill the whole ball only if they surround its centre
    const double whole = centre_outside[k] ? 0.0 : 4.0 * pi;
    parts[k].volume = whole * r * r * r / 3.0 - cut[k].volume;
    parts[k].area = whole * r * r - cut[k].area;
  }
  return parts;
}

SolidUnion solid_union(const PoreNetwork& network, const Spheres& vertices,
                       const Spheres& spheres) {
  SolidUnion solid;
  for (const SolidUnion& part : solid_parts(network, vertices, spheres)) {
    solid.volume += part.volume;
    solid.area += part.area;
  }
  return solid;
}

std::vector<double> doubled_volumes(const PoreNetwork& network, const Spheres& vertices,
                                    const Spheres& spheres) {
  const std::vector<char> outside = centres_outside(network, vertices, spheres.size());
  std::vector<double> volumes(network.pores(), 0.0);
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i) {
      double& volume = volumes[network.cell_pore[c]];
      for (int j = 0; j < 4; ++j)
        if (i != j) volume += cut_within_cell(network, vertices, c, i, j).volume;
      if (!outside[network.vertex_sphere[cell[i]]]) continue;
      const auto towards = [&](int other) { return vertices.towards(cell[i], cell[(i + other) % 4]); };
      volume += std::abs(solid_angle(towards(1), towards(2), towards(3))) * std::pow(vertices.radii[cell[i]], 3) / 3.0;
    }
  }
  return volumes;
}

}  // namespace pfv
