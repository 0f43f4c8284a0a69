// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/pore_network.hpp"

#include "network/canonical_order.hpp"
#include "network/disjoint_sets.hpp"
#include "network/facets.hpp"
#include "network/periodic_images.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pfv {

namespace {

/// Distance below which two dual vertices are one, in mean sphere spacings. The throat between them
/// would conduct some 1e6 times more than its neighbours, so that to join them changes pressures by
/// that little, while keeping them apart would cost the balances six digits.
constexpr double merge_distance = 1e-6;

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

/// Joins cells whose dual vertices are one, and each flat cell to the neighbour whose dual vertex is
/// nearest: the polygon that a flat cell splits in two sheets becomes one throat again.
std::vector<int> join_cells(const CellCentres& centres, const std::vector<Facet>& facets,
                            const Spheres& spheres, double spacing) {
  const int cells = static_cast<int>(centres.places.cols());
  DisjointSets sets(cells);
  std::vector<double> nearest(cells, std::numeric_limits<double>::infinity());
  std::vector<int> neighbour(cells, -1);
  for (const Facet& facet : facets) {
    const double length = dual_length(facet, centres.places, spheres);
    if (length < merge_distance * spacing) sets.join(facet.cells[0], facet.cells[1]);
    for (int side = 0; side < 2; ++side) {
      const int cell = facet.cells[side];
      if (!centres.flat[cell] || !(length < nearest[cell])) continue;
      nearest[cell] = length;
      neighbour[cell] = facet.cells[1 - side];
    }
  }
  for (int c = 0; c < cells; ++c)
    if (neighbour[c] >= 0) sets.join(c, neighbour[c]);
  std::vector<int> first(cells);
  for (int c = 0; c < cells; ++c) first[c] = sets.find(c);
  return first;
}

/// The centre of a pore is the dual vertex of one of its cells: not a flat one if it has others, and one with as many
/// walls as possible, so that it lies on the faces that the pore touches; of several such the first by name, so
/// that all images of a pore take the same one: beside a round wall they may be far apart.
void choose_pore_centres(PoreNetwork& network, int pores, const std::vector<char>& flat, const Spheres& spheres) {
  std::vector<int> chosen(pores, -1), rank(pores, -1);
  const auto name = [&](int cell) { return cell_name(network.cell_vertices[cell], spheres); };
  for (int c = 0; c < network.cells(); ++c) {
    const auto& vertices = network.cell_vertices[c];
    const auto walls = static_cast<int>(std::count_if(vertices.begin(), vertices.end(), is_wall));
    const int pore = network.cell_pore[c], own = walls + (flat[c] ? 0 : 4);
    if (own < rank[pore] || (own == rank[pore] && !(name(c) < name(chosen[pore])))) continue;
    rank[pore] = own;
    chosen[pore] = c;
  }
  network.pore_centres.resize(3, pores);
  for (int pore = 0; pore < pores; ++pore)
    network.pore_centres.col(pore) = network.cell_centres.col(chosen[pore]);
}

void make_pores_of_cells(PoreNetwork& network, const std::vector<int>& first, const std::vector<char>& flat,
                         const Spheres& spheres) {
  network.cell_pore.assign(network.cells(), -1);
  int pores = 0;
  for (int c = 0; c < network.cells(); ++c)  // the first of a pore has its number already
    network.cell_pore[c] = first[c] == c ? pores++ : network.cell_pore[first[c]];
  choose_pore_centres(network, pores, flat, spheres);
  network.pore_faces.assign(pores, 0);
  for (int c = 0; c < network.cells(); ++c)
    for (const Vertex vertex : network.cell_vertices[c])
      if (is_wall(vertex))
        network.pore_faces[network.cell_pore[c]] |=
            face_bit(wall_number(vertex));
}

/// Turns a facet round: cell 0 is the one of the pore with the smaller number.
Facet towards_larger_pore(Facet facet, const std::vector<int>& cell_pore) {
  if (cell_pore[facet.cells[0]] <= cell_pore[facet.cells[1]]) return facet;
  return {reversed(facet.vertices), {facet.cells[1], facet.cells[0]}};
}

std::array<int, 2> pores_of(const Facet& facet, const std::vector<int>& cell_pore) {
  return {cell_pore[facet.cells[0]], cell_pore[facet.cells[1]]};
}

/// Sorts facets by their pores, those within a pore last, and keeps the order of those with the same
/// pores. Returns the number of those between two pores.
int sort_by_pores(std::vector<Facet>& facets, const std::vector<int>& cell_pore, int pores) {
  std::vector<int> begin(pores + 2, 0);
  const auto bin_of = [&](const Facet& facet) {
    const auto [first, second] = pores_of(facet, cell_pore);
    return first == second ? pores : first;
  };
  for (const Facet& facet : facets) ++begin[bin_of(facet) + 1];
  for (int bin = 0; bin <= pores; ++bin) begin[bin + 1] += begin[bin];
  std::vector<Facet> sorted(facets.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const Facet& facet : facets) {
    // a pore has few throats: each new facet moves past those towards larger pores
    const int bin = bin_of(facet), second = cell_pore[facet.cells[1]];
    int place = next[bin]++;
    if (bin < pores)
      for (; place > begin[bin] && cell_pore[sorted[place - 1].cells[1]] > second; --place)
        sorted[place] = sorted[place - 1];
    sorted[place] = facet;
  }
  facets = std::move(sorted);
  return begin[pores];
}

/// Pieces of the polygon between two pores stand together and make one throat.
void group_facets_into_throats(PoreNetwork& network, std::vector<Facet>& facets) {
  for (Facet& facet : facets) facet = towards_larger_pore(facet, network.cell_pore);
  const int open = sort_by_pores(facets, network.cell_pore, network.pores());
  for (int f = 0; f < open; ++f) {
    const std::array<int, 2> both = pores_of(facets[f], network.cell_pore);
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
    if (i == 0 && is_wall(network.cell_vertices[cell][1])) continue;  // a corner of the box
    const auto facet = facet_opposite(network.cell_vertices[cell], i);
    const double distance =
        (place - spheres.centres.col(facet[0])).dot(unit_normal(facet, spheres));
    if (distance > worst.first) worst = {distance, i};
  }
  return worst;
}

}  // namespace

Cells find_cells(const Spheres& spheres) {
  Cells cells{triangulate(spheres), {}};
  cells.centres = cell_centres(cells.triangulation, spheres);
  return cells;
}

std::vector<int> first_cells(const Cells& cells, const Spheres& spheres, double spacing) {
  return join_cells(cells.centres, list_facets(cells.triangulation), spheres, spacing);
}

PoreNetwork network_of(Cells&& cells, const Spheres& spheres, double spacing) {
  std::vector<Facet> facets = list_facets(cells.triangulation);
  const std::vector<int> first = join_cells(cells.centres, facets, spheres, spacing);
  PoreNetwork network;
  network.vertex_sphere.resize(spheres.size());
  std::iota(network.vertex_sphere.begin(), network.vertex_sphere.end(), 0);
  network.cell_centres = std::move(cells.centres.places);
  network.cell_vertices = std::move(cells.triangulation.vertices);
  network.cell_neighbours = std::move(cells.triangulation.neighbours);
  network.hidden = std::move(cells.triangulation.hidden);
  make_pores_of_cells(network, first, cells.centres.flat, spheres);
  group_facets_into_throats(network, facets);
  return network;
}

PoreSpace build_network(const Spheres& spheres, const Eigen::Vector3d& origin) {
  const double spacing = std::cbrt(spheres.volume / std::max(1, spheres.size()));
  PoreSpace space;
  const auto& periodic = spheres.periodic;
  if (std::find(periodic.begin(), periodic.end(), true) == periodic.end() || spheres.size() == 0) {
    space.network = network_of(find_cells(spheres), spheres, spacing);
    space.spheres = spheres;
  } else {
    const double largest = spheres.radii.maxCoeff(), least = least_margin(spacing, largest);
    for (double margin = least;; margin *= 1.5) {
      refuse_endless_images(spheres.lattice(), spheres.size(), largest, margin, margin, margin == least);
      Images images = replicate(spheres, margin);
      const PoreNetwork all = network_of(find_cells(images.spheres), images.spheres, spacing);
      if (fold(all, images, spheres, spacing, space.network)) {
        space.spheres = std::move(images.spheres);
        break;
      }
    }
  }
  space.network.origin = origin;
  return space;
}

int walk_to(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place, int start) {
  int cell = start;
  for (int steps = 0; steps < network.cells(); ++steps) {
    const auto [distance, facet] = outside_by(network, spheres, place, cell);
    if (distance <= 0.0) return cell;
    cell = network.cell_neighbours[cell][facet];
    if (cell < 0) return -1;
  }
  return -1;  // between flat cells round-off can do that
}

int locate(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place,
           int start) {
  if (const int cell = walk_to(network, spheres, place, start); cell >= 0) return cell;
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

double distance_outside(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place, int cell) {
  return outside_by(network, spheres, place, cell).first;
}

}  // namespace pfv
