// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/mesh_walls.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace pfv_test {

using Triangles = std::vector<pfv::Triangle>;

inline void add_triangle(Triangles& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  mesh.emplace_back();
  mesh.back() << a, b, c;
}
inline void add_quad(Triangles& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

inline Triangles block_mesh(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  Triangles mesh;
  const auto at = [&](int i, int j, int k) {
    return Eigen::Vector3d(i ? upper[0] : lower[0], j ? upper[1] : lower[1], k ? upper[2] : lower[2]);
  };
  add_quad(mesh, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  add_quad(mesh, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  add_quad(mesh, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  add_quad(mesh, at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  add_quad(mesh, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  add_quad(mesh, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  return mesh;
}

/// An octahedron, its sides divided so often and blown up to the sphere; some triangles point inwards.
inline Triangles sphere_mesh(const Eigen::Vector3d& centre, double radius, int divided) {
  std::vector<std::array<Eigen::Vector3d, 3>> sides;
  for (int i = 0; i < 8; ++i)
    sides.push_back({Eigen::Vector3d(i & 1 ? 1 : -1, 0, 0), Eigen::Vector3d(0, i & 2 ? 1 : -1, 0),
                     Eigen::Vector3d(0, 0, i & 4 ? 1 : -1)});
  for (int turn = 0; turn < divided; ++turn) {
    decltype(sides) finer;
    for (const auto& s : sides) {
      const std::array<Eigen::Vector3d, 3> m{(s[0] + s[1]).normalized(), (s[1] + s[2]).normalized(), (s[2] + s[0]).normalized()};
      finer.insert(finer.end(), {{s[0], m[0], m[2]}, {m[0], s[1], m[1]}, {m[2], m[1], s[2]}, {m[0], m[1], m[2]}});
    }
    sides = finer;
  }
  Triangles mesh;
  for (const auto& s : sides) add_triangle(mesh, centre + radius * s[0], centre + radius * s[1], centre + radius * s[2]);
  return mesh;
}

inline Triangles cylinder_mesh(const Eigen::Vector3d& centre, double radius, double height, int sides) {
  Triangles mesh;
  const Eigen::Vector3d up(0, 0, height), low = centre - 0.5 * up;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * M_PI * i / sides, b = 2 * M_PI * (i + 1) / sides;
    const Eigen::Vector3d p = low + radius * Eigen::Vector3d(std::cos(a), std::sin(a), 0);
    const Eigen::Vector3d q = low + radius * Eigen::Vector3d(std::cos(b), std::sin(b), 0);
    add_quad(mesh, p, q, q + up, p + up);
    add_triangle(mesh, low, q, p);
    add_triangle(mesh, low + up, p + up, q + up);
  }
  return mesh;
}

/// A rectangle at z = height.
inline Triangles plate_mesh(double x0, double x1, double y0, double y1, double height) {
  Triangles mesh;
  add_quad(mesh, {x0, y0, height}, {x1, y0, height}, {x1, y1, height}, {x0, y1, height});
  return mesh;
}

}  // namespace pfv_test
