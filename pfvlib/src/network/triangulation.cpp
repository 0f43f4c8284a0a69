// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/triangulation.hpp"

#include "geometry/pi.hpp"
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

/// A plane that stands for a wall or, tangent to it, for a part of a round one.
struct Flat {
  Surface plane;
  int axis;  ///< that the plane is normal to, or -1
  Vertex wall;
};

/// Tangent planes of a cylinder: so many that between two of them it stands back from their edge by no more
/// than a hundredth of the mean sphere's radius, within bounds.
int flats_of_cylinder(const Spheres& spheres, double radius) {
  constexpr double depth = 0.01;
  constexpr int fewest = 32, most = 256;
  if (!(spheres.mean_radius > 0.0)) return fewest;
  const double gap = depth * spheres.mean_radius / radius;
  const int flats = static_cast<int>(std::ceil(pi / std::sqrt(2.0 * gap)));
  return std::min(std::max(flats, fewest), most);
}

std::vector<Flat> flats_of(const Spheres& spheres) {
  std::vector<Flat> flats;
  for (int w = 0; w < spheres.wall_count(); ++w) {
    const WallSurface& wall = spheres.walls[w];
    if (wall.axis >= 0 && spheres.periodic[wall.axis]) continue;
    if (wall.is_plane()) {
      flats.push_back({wall.surface, wall.axis, wall_vertex(w)});
      continue;
    }
    const int count = flats_of_cylinder(spheres, wall.surface.radius);
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * pi * (i + 0.5) / count;
      const Eigen::Vector3d normal = std::cos(angle) * wall.first + std::sin(angle) * wall.second;
      flats.push_back({Surface::plane(normal, wall.surface.point + wall.surface.radius * normal), -1,
                       wall_vertex(w)});
    }
  }
  return flats;
}

/// The sphere that stands for a plane touches it near the middle of the container.
Site flat_site(const Spheres& spheres, const Flat& flat) {
  double extent = spheres.edges.maxCoeff();
  if (spheres.size() > 0)  // images of a periodic box stand outside it
    extent = std::max(extent, spheres.spread > 0.0 ? spheres.spread
                                                   : (spheres.centres.rowwise().maxCoeff() -
                                                      spheres.centres.rowwise().minCoeff())
                                                         .maxCoeff());
  // a power of two, so that R and R² are exact
  const double radius = std::exp2(std::ceil(std::log2(wall_radius_in_box_lengths * extent)));
  Eigen::Vector3d centre = 0.5 * spheres.edges;
  if (flat.axis >= 0) {
    const double side = flat.plane.normal[flat.axis];
    centre[flat.axis] = side * (flat.plane.offset + radius);
  } else {
    centre += (flat.plane.distance(centre) + radius) * flat.plane.normal;
  }
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

/// `info` of a vertex is its sphere's place in `order`, or the number of its flat, as that of a wall.
Regular build(const Spheres& spheres, const std::vector<Vertex>& order, const std::vector<Flat>& flats) {
  Regular regular;
  for (std::size_t flat = 0; flat < flats.size(); ++flat)
    regular.insert(flat_site(spheres, flats[flat]))->info() = wall_vertex(static_cast<int>(flat));
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

/// What becomes of a cell.
enum class Fate {
  kept,      ///< it has a sphere, and its walls meet
  between,   ///< it lies between two flats of one round wall, which are one wall: nothing is there
  outside    ///< of the container
};

bool are_parallel(const Flat& a, const Flat& b) { return a.plane.normal == -b.plane.normal; }

Fate fate_of(const std::array<Vertex, 4>& vertices, const std::vector<Flat>& flats) {
  int walls = 0;
  bool twice = false;
  for (int i = 0; i < 4; ++i) {
    if (!is_wall(vertices[i])) continue;
    ++walls;
    for (int j = 0; j < i; ++j) {
      if (!is_wall(vertices[j])) continue;
      const Flat &a = flats[wall_number(vertices[i])], &b = flats[wall_number(vertices[j])];
      if (a.wall == b.wall) twice = true;
      else if (are_parallel(a, b)) return Fate::outside;
    }
  }
  if (walls == 4) return Fate::outside;
  return twice ? Fate::between : Fate::kept;
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

constexpr int outside = -1, between = -2;  // in the place of a cell's number

/// The cells of the container in order; the `info` of each is its number, of the others why they are none.
std::vector<Regular::Cell_handle> number_cells(const Regular& regular, int spheres,
                                               const std::vector<Flat>& flats) {
  std::vector<Regular::Cell_handle> found, cells;
  std::vector<std::array<Vertex, 4>> vertices;
  found.reserve(regular.number_of_finite_cells());
  vertices.reserve(regular.number_of_finite_cells());
  for (auto cell = regular.all_cells_begin(); cell != regular.all_cells_end(); ++cell) {
    cell->info() = outside;
    if (regular.is_infinite(cell)) continue;
    const auto own = vertices_of(cell);
    const Fate fate = fate_of(own, flats);
    if (fate == Fate::between) cell->info() = between;
    if (fate != Fate::kept) continue;
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

/// The two flats of one round wall in a cell between them: `known` is one, the other is returned.
Vertex other_flat(Regular::Cell_handle cell, Vertex known, const std::vector<Flat>& flats) {
  for (const Vertex v : vertices_of(cell))
    if (v != known && is_wall(v) && flats[wall_number(v)].wall == flats[wall_number(known)].wall) return v;
  return known;
}

/// The number of the cell beyond facet i, with the round walls as one: cells between two flats of a wall have
/// no thickness, so the way goes on through them, along the wall.
int neighbour_of(Regular::Cell_handle cell, int i, const std::vector<Flat>& flats) {
  Regular::Cell_handle next = cell->neighbor(i);
  if (next->info() != between) return next->info();
  Vertex known = 0;
  for (int k = 0; k < 4; ++k) {
    const Vertex v = cell->vertex(k)->info();
    if (k != i && is_wall(v) && other_flat(next, v, flats) != v) known = v;
  }
  while (next->info() == between && known < 0) {
    const Vertex other = other_flat(next, known, flats);
    int exit = -1;
    for (int k = 0; k < 4; ++k)
      if (next->vertex(k)->info() == known) exit = k;
    if (exit < 0 || other == known) return outside;
    next = next->neighbor(exit);
    known = other;
  }
  return std::max(next->info(), outside);
}

/// Spheres around which all cells lie between flats of a round wall: they see nothing but that wall.
void refuse_lone_spheres(const Triangulation& result, const Spheres& spheres) {
  std::vector<char> seen(spheres.size(), 0);
  for (const auto& cell : result.vertices)
    for (const Vertex v : cell)
      if (!is_wall(v)) seen[v] = 1;
  for (const int k : result.hidden) seen[k] = 1;
  std::vector<int> alone;
  for (int k = 0; k < spheres.size(); ++k)
    if (!seen[k]) alone.push_back(k);
  if (alone.empty()) return;
  sort_by_ids(alone, spheres);
  throw InputError(sphere_list(spheres.ids, alone) +
                       ": too few others stand around it in the cylinder for pores to exist there, but ones that reach "
                       "around the axis; for grains that move through the fluid take flats in place of the cylinder "
                       "(container file: \"flats\": 32; fix: `container flats`); a flow through a tube with so few "
                       "grains is more water than bed and has no good answer with this method (doc/container.md)",
                   {{spheres.ids[alone.front()]}, {}});
}

}  // namespace

Triangulation triangulate(const Spheres& spheres) {
  const std::vector<Vertex> order = along_curve(spheres);
  const std::vector<Flat> flats = flats_of(spheres);
  const Regular regular = build(spheres, order, flats);
  Triangulation result;
  if (regular.number_of_vertices() < static_cast<std::size_t>(spheres.size()) + flats.size()) {
    refuse_equal_centres(spheres);
    result.hidden = hidden_spheres(regular, order, spheres);
  }
  const auto cells = number_cells(regular, spheres.size(), flats);
  result.vertices.resize(cells.size());
  result.neighbours.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    auto& vertices = result.vertices[c];
    vertices = vertices_of(cells[c]);
    for (Vertex& vertex : vertices)
      vertex = is_wall(vertex) ? flats[wall_number(vertex)].wall : order[vertex];
    for (int i = 0; i < 4; ++i) result.neighbours[c][i] = neighbour_of(cells[c], i, flats);
    arrange(vertices, result.neighbours[c], spheres);
  }
  if (flats.size() > static_cast<std::size_t>(spheres.wall_count())) refuse_lone_spheres(result, spheres);
  return result;
}

}  // namespace pfv
