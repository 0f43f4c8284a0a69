// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/wanted_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pfv {

namespace {

/// A round wall's cells are found with planes that stand a little off it: their balls are those of other centres.
constexpr double allowance_at_round_walls = 0.5;

template <class Is>
bool any_sphere(const std::array<Vertex, 4>& cell, const Is& is) {
  return std::any_of(cell.begin(), cell.end(), [&](Vertex v) { return !is_wall(v) && is(v); });
}

/// All cells of a pore or none.
void complete_pores(const std::vector<int>& first, std::vector<char>& cells) {
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c]) cells[first[c]] = 1;
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = cells[first[c]];
}

}  // namespace

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

Halo::Query ball_of(const Cells& cells, std::size_t cell, const Spheres& spheres, double largest_radius) {
  const auto& vertices = cells.triangulation.vertices[cell];
  const Eigen::Vector3d centre = cells.centres.places.col(static_cast<Eigen::Index>(cell));
  double power = 0.0;
  for (const Vertex v : vertices)
    if (!is_wall(v))
      power = std::max(power, (centre - spheres.centres.col(v)).squaredNorm() - spheres.radii[v] * spheres.radii[v]);
  if (std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) { return is_wall(v) && !spheres.wall(v).is_plane(); }))
    power = std::pow((1.0 + allowance_at_round_walls) * std::sqrt(power) + allowance_at_round_walls * largest_radius, 2);
  return {centre, power};
}

double reach_of(const Halo::Query& ball, double largest_radius) {
  return std::sqrt(ball.power + largest_radius * largest_radius) * (1.0 + 1e-9);
}

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
    std::array<Vertex, 4> vertices = all.triangulation.vertices[c];
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

std::vector<int> keep_spheres(const std::vector<char>& used, Halo& halo, const Container& container, ActiveGrains& grains) {
  std::vector<char> columns(static_cast<std::size_t>(halo.seen().size()), 0);
  for (std::size_t i = 0; i < used.size(); ++i) columns[grains.columns[i]] = used[i];
  const std::vector<std::int64_t> before(grains.spheres.ids.data(), grains.spheres.ids.data() + used.size());
  halo.keep(columns);
  grains = halo.active_grains(container);
  // both stand in the order of the packing's columns or, of ghosts, of who told of them
  std::vector<std::pair<std::int64_t, int>> now;
  for (int i = 0; i < grains.spheres.size(); ++i) now.push_back({grains.spheres.ids[i], i});
  std::sort(now.begin(), now.end());
  std::vector<int> number(used.size(), -1);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    number[i] = std::lower_bound(now.begin(), now.end(), std::pair(before[i], -1))->second;
  }
  return number;
}

}  // namespace pfv
