// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"

#include <array>
#include <vector>

namespace pfv {

/// Connectivity of the regular (weighted Delaunay) triangulation of spheres and walls: the cells
/// inside the container. Spheres come first among the vertices of a cell, and its orientation is positive; this
/// and the order of the cells is that of canonical_order.hpp.
struct Triangulation {
  std::vector<std::array<Vertex, 4>> vertices;
  std::vector<std::array<int, 4>> neighbours;  ///< opposite each vertex; -1 outside the container
  std::vector<int> hidden;                     ///< spheres with an empty power cell, by ids
};

/// The only place that uses CGAL. Predicates are exact; a wall enters as a sphere whose radius is
/// some 1e7 box lengths, for the topology only: geometry is computed with the plane.
/// A cylinder enters as planes that touch it around, which become one wall. Cospherical sets are
/// split by CGAL's symbolic perturbation, which asks for the places of their spheres alone.
/// Throws InputError when two spheres have the same centre. Cost: 4-6 µs a sphere.
Triangulation triangulate(const Spheres& spheres);

}  // namespace pfv
