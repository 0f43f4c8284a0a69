// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/pore_network.hpp"

#include "network/cell_centres.hpp"
#include "network/disjoint_sets.hpp"
#include "network/facets.hpp"
#include "network/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// Distance below which two dual vertices are one, in mean sphere spacings.
constexpr double merge_distance = 1e-8;

struct Facet {
  std::array<Vertex, 3> vertices;
  std::array<int, 2> cells;
};

std::vector<Facet> list_facets(const Triangulation& triangulation) {
  std::vector<Facet> facets;
  const int cells = static_cast<int>(triangulation.vertices.size());
  facets.reserve(2 * static_cast<std::size_t>(cells));
  for (int c = 0; c < cells; ++c)
    for (int i = 0; i < 4; ++i) {
      const int neighbour = triangulation.neighbours[c][i];
      if (neighbour > c)
        facets.push_back({facet_opposite(triangulation.vertices[c], i), {c, neighbour}});
    }
  return facets;
}

/// The dual edge from cell 0 to cell 1 has the direction of the facet's normal; round-off may turn
/// the shortest ones, which is why the signed length is compared.
double dual_length(const Facet& facet, const Eigen::Matrix3Xd& centres, const Spheres& spheres) {
  return (centres.col(facet.cells[1]) - centres.col(facet.cells[0]))
      .dot(unit_normal(facet.vertices, spheres));
}

void join_cells_into_pores(PoreNetwork& network, const std::vector<Facet>& facets,
                           const Spheres& spheres) {
  const int cells = network.cells();
  const double spacing = std::cbrt(spheres.edges.prod() / std::max(1, spheres.size()));
  DisjointSets sets(cells);
  for (const Facet& facet : facets)
    if (dual_length(facet, network.cell_centres, spheres) < merge_distance * spacing)
      sets.join(facet.cells[0], facet.cells[1]);

  network.cell_pore.assign(cells, -1);
  std::vector<int> first_cell;
  for (int c = 0; c < cells; ++c) {
    const int root = sets.find(c);  // the smallest of the set, so it has its pore already
    if (root == c) {
      network.cell_pore[c] = static_cast<int>(first_cell.size());
      first_cell.push_back(c);
    } else {
      network.cell_pore[c] = network.cell_pore[root];
    }
  }
  network.pore_centres.resize(3, static_cast<Eigen::Index>(first_cell.size()));
  for (std::size_t p = 0; p < first_cell.size(); ++p)
    network.pore_centres.col(static_cast<Eigen::Index>(p)) = network.cell_centres.col(first_cell[p]);
  network.pore_faces.assign(first_cell.size(), 0);
  for (int c = 0; c < cells; ++c)
    for (const Vertex vertex : network.cell_vertices[c])
      if (is_wall(vertex))
        network.pore_faces[network.cell_pore[c]] |=
            static_cast<std::uint8_t>(1u << wall_number(vertex));
}

/// Turns a facet round: cell 0 is the one of the pore with the smaller number.
Facet towards_larger_pore(Facet facet, const std::vector<int>& cell_pore) {
  if (cell_pore[facet.cells[0]] <= cell_pore[facet.cells[1]]) return facet;
  std::swap(facet.cells[0], facet.cells[1]);
  const bool slab = is_wall(facet.vertices[1]);
  std::swap(facet.vertices[slab ? 1 : 0], facet.vertices[slab ? 2 : 1]);
  return facet;
}

/// Pieces of the polygon between two pores stand together and make one throat.
void group_facets_into_throats(PoreNetwork& network, std::vector<Facet>& facets) {
  const auto pores = [&](const Facet& facet) {
    return std::array<int, 2>{network.cell_pore[facet.cells[0]],
                              network.cell_pore[facet.cells[1]]};
  };
  const auto internal = [&](const Facet& facet) { return pores(facet)[0] == pores(facet)[1]; };
  for (Facet& facet : facets) facet = towards_larger_pore(facet, network.cell_pore);
  const auto last_open = std::stable_partition(facets.begin(), facets.end(),
                                               [&](const Facet& f) { return !internal(f); });
  std::stable_sort(facets.begin(), last_open,
                   [&](const Facet& a, const Facet& b) { return pores(a) < pores(b); });

  const int open = static_cast<int>(last_open - facets.begin());
  for (int f = 0; f < open; ++f) {
    const std::array<int, 2> both = pores(facets[f]);
    if (network.throat_pores.empty() || network.throat_pores.back() != both) {
      network.throat_pores.push_back(both);
      network.throat_facets.push_back(f);
    }
  }
  network.throat_facets.push_back(open);
  network.facet_vertices.reserve(facets.size());
  network.facet_cells.reserve(facets.size());
  for (const Facet& facet : facets) {
    network.facet_vertices.push_back(facet.vertices);
    network.facet_cells.push_back(facet.cells);
  }
}

/// Largest distance by which a place lies outside a cell, and the facet where; <= 0 inside.
std::pair<double, int> outside_by(const PoreNetwork& network, const Spheres& spheres,
                                  const Eigen::Vector3d& place, int cell) {
  std::pair<double, int> worst{-std::numeric_limits<double>::infinity(), 0};
  for (int i = 0; i < 4; ++i) {
    if (network.cell_neighbours[cell][i] < 0) continue;
    const auto facet = facet_opposite(network.cell_vertices[cell], i);
    const double distance =
        (place - spheres.centres.col(facet[0])).dot(unit_normal(facet, spheres));
    if (distance > worst.first) worst = {distance, i};
  }
  return worst;
}

}  // namespace

PoreNetwork build_network(const Spheres& spheres, const Eigen::Vector3d& origin) {
  Triangulation triangulation = triangulate(spheres);
  std::vector<Facet> facets = list_facets(triangulation);
  PoreNetwork network;
  network.origin = origin;
  network.cell_centres = cell_centres(triangulation, spheres);
  network.cell_vertices = std::move(triangulation.vertices);
  network.cell_neighbours = std::move(triangulation.neighbours);
  network.hidden = std::move(triangulation.hidden);
  join_cells_into_pores(network, facets, spheres);
  group_facets_into_throats(network, facets);
  return network;
}

int locate(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place,
           int start) {
  int cell = start;
  for (int steps = 0; steps < network.cells(); ++steps) {
    const auto [distance, facet] = outside_by(network, spheres, place, cell);
    if (distance <= 0.0) return cell;
    cell = network.cell_neighbours[cell][facet];
  }
  // round-off can make a walk run in a circle between flat cells: take the least bad cell
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < network.cells(); ++c) {
    const double distance = outside_by(network, spheres, place, c).first;
    if (distance < least) {
      least = distance;
      best = c;
    }
  }
  return best;
}

}  // namespace pfv
