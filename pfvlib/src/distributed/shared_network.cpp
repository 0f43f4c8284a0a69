// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/shared_network.hpp"

#include "distributed/pore_owners.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pfv {

namespace {

using CellVertices = std::array<Vertex, 4>;

/// Which cells this rank keeps.
struct Wanted {
  std::vector<char> cells;
  std::vector<char> whole_cells;    ///< of these, those whose pores have all their throats
  std::vector<char> whole_spheres;  ///< own ones and those of pores with one
};

template <class Is>
bool any_sphere(const CellVertices& cell, const Is& is) {
  return std::any_of(cell.begin(), cell.end(), [&](Vertex v) { return !is_wall(v) && is(v); });
}

/// All cells of a pore or none.
void complete_pores(const std::vector<int>& first, std::vector<char>& cells) {
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c]) cells[first[c]] = 1;
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = cells[first[c]];
}

/// Own pores, all that stands around their spheres, and one layer of cells more.
Wanted wanted_cells(const Triangulation& triangulation, const std::vector<int>& first, const std::vector<char>& is_own) {
  const std::size_t cells = triangulation.vertices.size();
  Wanted wanted{{}, std::vector<char>(cells, 0), is_own};
  std::vector<char>& whole = wanted.whole_cells;
  const auto take_cells_at = [&](const std::vector<char>& spheres) {
    for (std::size_t c = 0; c < cells; ++c)
      whole[c] = whole[c] || any_sphere(triangulation.vertices[c], [&](Vertex v) { return spheres[v]; });
    complete_pores(first, whole);
  };
  take_cells_at(is_own);
  for (std::size_t c = 0; c < cells; ++c)
    for (const Vertex v : triangulation.vertices[c])
      if (whole[c] && !is_wall(v)) wanted.whole_spheres[v] = 1;
  take_cells_at(wanted.whole_spheres);
  wanted.cells = whole;
  for (std::size_t c = 0; c < cells; ++c)
    if (whole[c])
      for (const int neighbour : triangulation.neighbours[c])
        if (neighbour >= 0) wanted.cells[neighbour] = 1;
  complete_pores(first, wanted.cells);
  return wanted;
}

/// A round wall's cells are found with planes that stand a little off it: their balls are those of other centres.
constexpr double allowance_at_round_walls = 0.5;

/// What to ask for: cells whose ball leaves the place where all grains are known.
std::vector<Halo::Query> queries_of(const Cells& cells, const std::vector<char>& wanted, const Spheres& spheres,
                                    const Halo& halo) {
  const double widest = halo.totals().largest_radius;
  const Bounds& known = halo.known();
  std::vector<Halo::Query> queries;
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    if (!wanted[c]) continue;
    const Eigen::Vector3d centre = cells.centres.places.col(static_cast<Eigen::Index>(c));
    double power = 0.0;
    for (const Vertex v : cells.triangulation.vertices[c])
      if (!is_wall(v))
        power = std::max(power, (centre - spheres.centres.col(v)).squaredNorm() - spheres.radii[v] * spheres.radii[v]);
    const auto& cell = cells.triangulation.vertices[c];
    if (std::any_of(cell.begin(), cell.end(), [&](Vertex v) { return is_wall(v) && !spheres.wall(v).is_plane(); }))
      power = std::pow((1.0 + allowance_at_round_walls) * std::sqrt(power) + allowance_at_round_walls * widest, 2);
    const double reach = std::sqrt(power + widest * widest) * (1.0 + 1e-9);
    const bool inside = (centre.array() - reach >= known.lower.array()).all() &&
                        (centre.array() + reach <= known.upper.array()).all();
    if (!inside) queries.push_back({centre, power});
  }
  return queries;
}

/// Cells without those that are not wanted.
Cells kept_cells(const Cells& all, const std::vector<char>& wanted, const std::vector<int>& new_vertex) {
  std::vector<int> number(wanted.size(), -1);
  int count = 0;
  for (std::size_t c = 0; c < wanted.size(); ++c)
    if (wanted[c]) number[c] = count++;
  Cells kept;
  kept.triangulation.vertices.reserve(count);
  kept.triangulation.neighbours.reserve(count);
  kept.centres.places.resize(3, count);
  kept.centres.flat.reserve(count);
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    if (!wanted[c]) continue;
    CellVertices vertices = all.triangulation.vertices[c];
    std::array<int, 4> neighbours = all.triangulation.neighbours[c];
    for (int i = 0; i < 4; ++i) {
      if (!is_wall(vertices[i])) vertices[i] = new_vertex[vertices[i]];
      if (neighbours[i] >= 0) neighbours[i] = number[neighbours[i]];
    }
    kept.centres.places.col(number[c]) = all.centres.places.col(static_cast<Eigen::Index>(c));
    kept.centres.flat.push_back(all.centres.flat[c]);
    kept.triangulation.vertices.push_back(vertices);
    kept.triangulation.neighbours.push_back(neighbours);
  }
  for (const int hidden : all.triangulation.hidden)
    if (new_vertex[hidden] >= 0) kept.triangulation.hidden.push_back(new_vertex[hidden]);
  return kept;
}

std::vector<char> own_spheres(const ActiveGrains& grains, const Halo& halo) {
  std::vector<char> own;
  for (const int column : grains.columns) own.push_back(column < halo.own_count());
  return own;
}

/// A triangulation that holds for all grains where it is wanted.
struct Certified {
  ActiveGrains grains;
  Cells cells;
  Wanted wanted;
};

Certified certified_cells(Halo& halo, const Container& container, double spacing, const Ranks& ranks) {
  Certified found;
  for (bool more = true; more;) {
    std::vector<Halo::Query> queries;
    ranks.together([&] {
      found.grains = halo.active_grains(container);
      const Spheres& spheres = found.grains.spheres;
      found.cells = {};
      if (!halo.places()[ranks.own()].is_empty()) found.cells = find_cells(spheres);
      found.wanted = wanted_cells(found.cells.triangulation, first_cells(found.cells, spheres, spacing),
                                  own_spheres(found.grains, halo));
      queries = queries_of(found.cells, found.wanted.cells, spheres, halo);
    });
    more = halo.ask(queries);
  }
  return found;
}

/// Drops ghosts that no kept cell has; returns the new number of each sphere, -1 for none.
std::vector<int> drop_unused_ghosts(Certified& found, Halo& halo, const Container& container) {
  const auto spheres = static_cast<std::size_t>(found.grains.spheres.size());
  std::vector<char> used = own_spheres(found.grains, halo);
  for (std::size_t c = 0; c < found.wanted.cells.size(); ++c)
    if (found.wanted.cells[c])
      for (const Vertex v : found.cells.triangulation.vertices[c])
        if (!is_wall(v)) used[v] = 1;
  std::vector<char> columns(static_cast<std::size_t>(halo.seen().size()), 0);
  for (std::size_t i = 0; i < spheres; ++i) columns[found.grains.columns[i]] = used[i];
  const std::vector<std::int64_t> before(found.grains.spheres.ids.data(), found.grains.spheres.ids.data() + spheres);
  halo.keep(columns);
  found.grains = halo.active_grains(container);
  // both stand in the order of the packing's columns or, of ghosts, of who told of them
  std::vector<std::pair<std::int64_t, int>> now;
  for (int i = 0; i < found.grains.spheres.size(); ++i) now.push_back({found.grains.spheres.ids[i], i});
  std::sort(now.begin(), now.end());
  std::vector<int> number(spheres, -1);
  for (std::size_t i = 0; i < spheres; ++i) {
    if (!used[i]) continue;
    number[i] = std::lower_bound(now.begin(), now.end(), std::pair(before[i], -1))->second;
  }
  return number;
}

}  // namespace

SharedNetwork build_shared_network(const Packing& own, const Container& container, OutsideGrains outside,
                                   std::shared_ptr<const Ranks> ranks) {
  SharedNetwork shared{Halo(own, container, outside, *ranks), {}, {}, {}};
  const double spacing = std::cbrt(volume_of(container) / std::max(1.0, shared.halo.totals().active));
  Certified found = certified_cells(shared.halo, container, spacing, *ranks);
  const std::vector<int> number = drop_unused_ghosts(found, shared.halo, container);
  shared.grains = std::move(found.grains);
  Share& share = shared.share;
  share.ranks = ranks;
  share.own_spheres = own_spheres(shared.grains, shared.halo);
  share.whole_spheres.assign(share.own_spheres.size(), 0);
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] >= 0) share.whole_spheres[number[i]] = found.wanted.whole_spheres[i];
  std::vector<char> whole_cells;
  for (std::size_t c = 0; c < found.wanted.cells.size(); ++c)
    if (found.wanted.cells[c]) whole_cells.push_back(found.wanted.whole_cells[c]);
  ranks->together([&] {
    shared.space.network = network_of(kept_cells(found.cells, found.wanted.cells, number), shared.grains.spheres, spacing);
    shared.space.spheres = shared.grains.spheres;
    shared.space.network.origin = container.lower;
  });
  find_owners(shared.space.network, shared.grains, shared.halo, whole_cells, share);
  return shared;
}

}  // namespace pfv
