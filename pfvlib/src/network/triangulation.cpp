// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/triangulation.hpp"

#include "pfv/error.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pfv {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<
    Vertex, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<
    int, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Regular =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Site = std::pair<Kernel::Weighted_point_3, Vertex>;

/// Radius of the spheres that stand for walls, in box lengths: curvature displaces a wall by
/// 1 / (8 R), rounding by some 1e-16 R; near 2^25 both are a few 1e-9 of the box.
constexpr double wall_radius_in_box_lengths = 33554432.0;

Site wall_site(const Spheres& spheres, int face) {
  double extent = spheres.edges.maxCoeff();
  if (spheres.size() > 0)  // images of a periodic box stand outside it
    extent = std::max(extent, (spheres.centres.rowwise().maxCoeff() -
                               spheres.centres.rowwise().minCoeff())
                                  .maxCoeff());
  // a power of two, so that R and R² are exact
  const double radius = std::exp2(std::ceil(std::log2(wall_radius_in_box_lengths * extent)));
  Eigen::Vector3d centre = 0.5 * spheres.edges;
  const int axis = face / 2;
  centre[axis] = face % 2 ? spheres.edges[axis] + radius : -radius;
  return {Kernel::Weighted_point_3(Kernel::Point_3(centre[0], centre[1], centre[2]),
                                   radius * radius),
          wall_vertex(face)};
}

Site sphere_site(const Spheres& spheres, int k) {
  const auto centre = spheres.centres.col(k);
  return {Kernel::Weighted_point_3(Kernel::Point_3(centre[0], centre[1], centre[2]),
                                   spheres.radii[k] * spheres.radii[k]),
          k};
}

Regular build(const Spheres& spheres) {
  std::vector<Site> sites;
  sites.reserve(spheres.size() + 6);
  for (int face = 0; face < 6; ++face)
    if (!spheres.periodic[face / 2]) sites.push_back(wall_site(spheres, face));
  for (int k = 0; k < spheres.size(); ++k) sites.push_back(sphere_site(spheres, k));
  Regular regular;
  regular.insert(sites.begin(), sites.end());
  return regular;
}

std::array<Vertex, 4> vertices_of(Regular::Cell_handle cell) {
  return {cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
          cell->vertex(3)->info()};
}

/// A cell of the box has a sphere, and no two opposite walls.
bool in_box(const std::array<Vertex, 4>& vertices) {
  int walls = 0;
  unsigned axes = 0, repeated = 0;
  for (const Vertex v : vertices) {
    if (!is_wall(v)) continue;
    ++walls;
    const unsigned axis = 1u << (wall_number(v) / 2);
    repeated |= axes & axis;
    axes |= axis;
  }
  return walls < 4 && repeated == 0;
}

/// Spheres first; an even permutation, so the orientation stays positive.
void put_spheres_first(std::array<Vertex, 4>& vertices, std::array<int, 4>& neighbours) {
  bool odd = false;
  const auto exchange = [&](int i, int j) {
    std::swap(vertices[i], vertices[j]);
    std::swap(neighbours[i], neighbours[j]);
    odd = !odd;
  };
  int spheres = 0;
  for (int i = 0; i < 4; ++i) {
    if (is_wall(vertices[i])) continue;
    if (i != spheres) exchange(i, spheres);
    ++spheres;
  }
  if (odd) spheres >= 2 ? exchange(0, 1) : exchange(2, 3);
}

std::vector<int> hidden_spheres(const Regular& regular, int spheres) {
  std::vector<char> seen(spheres, 0);
  for (auto v = regular.finite_vertices_begin(); v != regular.finite_vertices_end(); ++v)
    if (!is_wall(v->info())) seen[v->info()] = 1;
  std::vector<int> hidden;
  for (int k = 0; k < spheres; ++k)
    if (!seen[k]) hidden.push_back(k);
  return hidden;
}

/// Of two spheres with one centre at least one is hidden, so this is needed only then.
void refuse_equal_centres(const Spheres& spheres) {
  std::vector<int> order(spheres.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int k) {
    return std::array<double, 3>{spheres.centres(0, k), spheres.centres(1, k),
                                 spheres.centres(2, k)};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i - 1]) == key(order[i]))
      throw InputError("spheres " + std::to_string(spheres.ids[order[i - 1]]) + " and " +
                       std::to_string(spheres.ids[order[i]]) +
                           " have the same centre; remove or move one of them",
                       {{spheres.ids[order[i - 1]], spheres.ids[order[i]]}, {}});
}

}  // namespace

Triangulation triangulate(const Spheres& spheres) {
  const Regular regular = build(spheres);
  Triangulation result;
  const auto periodic = std::count(spheres.periodic.begin(), spheres.periodic.end(), true);
  const auto walls = static_cast<std::size_t>(6 - 2 * periodic);
  if (regular.number_of_vertices() < static_cast<std::size_t>(spheres.size()) + walls) {
    refuse_equal_centres(spheres);
    result.hidden = hidden_spheres(regular, spheres.size());
  }
  for (auto cell = regular.all_cells_begin(); cell != regular.all_cells_end(); ++cell)
    cell->info() = -1;
  std::vector<Regular::Cell_handle> cells;
  cells.reserve(regular.number_of_finite_cells());
  for (auto cell = regular.finite_cells_begin(); cell != regular.finite_cells_end(); ++cell) {
    if (!in_box(vertices_of(cell))) continue;
    cell->info() = static_cast<int>(cells.size());
    cells.push_back(cell);
  }
  result.vertices.resize(cells.size());
  result.neighbours.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    result.vertices[c] = vertices_of(cells[c]);
    for (int i = 0; i < 4; ++i) result.neighbours[c][i] = cells[c]->neighbor(i)->info();
    put_spheres_first(result.vertices[c], result.neighbours[c]);
  }
  return result;
}

}  // namespace pfv
