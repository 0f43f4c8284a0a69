// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/triangulation.hpp"

#include "network/canonical_order.hpp"
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
using Site = Kernel::Weighted_point_3;

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
  return Site(Kernel::Point_3(centre[0], centre[1], centre[2]), radius * radius);
}

Site sphere_site(const Spheres& spheres, int k) {
  const auto centre = spheres.centres.col(k);
  return Site(Kernel::Point_3(centre[0], centre[1], centre[2]),
              spheres.radii[k] * spheres.radii[k]);
}

/// Of the spheres along the curve one in 8^n is inserted first, then of the others one in 8^(n-1), and so
/// on: each begins its search next to the one before, in a triangulation that is never far from even.
constexpr int refinement = 8, coarsest = 64;

/// `info` of a vertex is its sphere's place in `order`, or a wall.
Regular build(const Spheres& spheres, const std::vector<Vertex>& order) {
  Regular regular;
  for (int face = 0; face < face_count; ++face)
    if (!spheres.periodic[face / 2])
      regular.insert(wall_site(spheres, face))->info() = wall_vertex(face);
  const int count = spheres.size();
  Regular::Cell_handle near{};
  const auto insert = [&](int place) {
    const auto vertex = regular.insert(sphere_site(spheres, order[place]), near);
    if (vertex == Regular::Vertex_handle()) return;  // hidden
    vertex->info() = place;
    near = vertex->cell();
  };
  int stride = 1;
  while (count / stride > coarsest) stride *= refinement;
  for (int place = 0; place < count; place += stride) insert(place);
  for (; stride > 1; stride /= refinement)
    for (int place = 0; place < count; place += stride / refinement)
      if (place % stride != 0) insert(place);
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

std::vector<int> hidden_spheres(const Regular& regular, const std::vector<Vertex>& order,
                                const Spheres& spheres) {
  std::vector<char> seen(spheres.size(), 0);
  for (auto v = regular.finite_vertices_begin(); v != regular.finite_vertices_end(); ++v)
    if (!is_wall(v->info())) seen[order[v->info()]] = 1;
  std::vector<int> hidden;
  for (int k = 0; k < spheres.size(); ++k)
    if (!seen[k]) hidden.push_back(k);
  sort_by_ids(hidden, spheres);
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
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_pair(key(a), spheres.ids[a]) < std::make_pair(key(b), spheres.ids[b]);
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i - 1]) == key(order[i]))
      throw InputError("spheres " + std::to_string(spheres.ids[order[i - 1]]) + " and " +
                       std::to_string(spheres.ids[order[i]]) +
                           " have the same centre; remove or move one of them",
                       {{spheres.ids[order[i - 1]], spheres.ids[order[i]]}, {}});
}

/// The cells of the box in order; the `info` of each is its number, of the others -1.
std::vector<Regular::Cell_handle> number_cells(const Regular& regular, int spheres) {
  std::vector<Regular::Cell_handle> found, cells;
  std::vector<std::array<Vertex, 4>> vertices;
  found.reserve(regular.number_of_finite_cells());
  vertices.reserve(regular.number_of_finite_cells());
  for (auto cell = regular.all_cells_begin(); cell != regular.all_cells_end(); ++cell) {
    cell->info() = -1;
    if (regular.is_infinite(cell)) continue;
    const auto own = vertices_of(cell);
    if (!in_box(own)) continue;
    found.push_back(cell);
    vertices.push_back(own);
  }
  cells.reserve(found.size());
  for (const int c : order_of_cells(vertices, spheres)) {
    found[c]->info() = static_cast<int>(cells.size());
    cells.push_back(found[c]);
  }
  return cells;
}

}  // namespace

Triangulation triangulate(const Spheres& spheres) {
  const std::vector<Vertex> order = along_curve(spheres);
  const Regular regular = build(spheres, order);
  Triangulation result;
  const auto periodic = std::count(spheres.periodic.begin(), spheres.periodic.end(), true);
  const auto walls = static_cast<std::size_t>(face_count - 2 * periodic);
  if (regular.number_of_vertices() < static_cast<std::size_t>(spheres.size()) + walls) {
    refuse_equal_centres(spheres);
    result.hidden = hidden_spheres(regular, order, spheres);
  }
  const auto cells = number_cells(regular, spheres.size());
  result.vertices.resize(cells.size());
  result.neighbours.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    auto& vertices = result.vertices[c];
    vertices = vertices_of(cells[c]);
    for (Vertex& vertex : vertices)
      if (!is_wall(vertex)) vertex = order[vertex];
    for (int i = 0; i < 4; ++i) result.neighbours[c][i] = cells[c]->neighbor(i)->info();
    arrange(vertices, result.neighbours[c], spheres);
  }
  return result;
}

}  // namespace pfv
