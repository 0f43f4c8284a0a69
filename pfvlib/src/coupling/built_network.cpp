// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/built_network.hpp"

#include "network/pore_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pfv {

namespace {

constexpr double pi = 3.14159265358979323846;

/// The vertices of each cell by the ids of their grains, ascending, with the number of the cell.
std::vector<std::pair<std::array<std::int64_t, 4>, int>> named_cells(const BuiltNetwork& built) {
  constexpr std::int64_t walls = std::numeric_limits<std::int64_t>::min();
  std::vector<std::pair<std::array<std::int64_t, 4>, int>> names(built.network.cells());
  for (int c = 0; c < built.network.cells(); ++c) {
    names[c].second = c;
    for (int i = 0; i < 4; ++i) {
      const Vertex vertex = built.network.cell_vertices[c][i];
      names[c].first[i] =
          is_wall(vertex) ? walls + wall_number(vertex) : built.vertices.ids[vertex];
    }
    std::sort(names[c].first.begin(), names[c].first.end());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// For each cell of `now` the cell of `old` with the same vertices, or -1.
std::vector<int> surviving_cells(const BuiltNetwork& old, const BuiltNetwork& now) {
  const auto before = named_cells(old), after = named_cells(now);
  std::vector<int> survivors(now.network.cells(), -1);
  auto next = before.begin();
  for (const auto& [name, cell] : after) {
    while (next != before.end() && next->first < name) ++next;
    if (next != before.end() && next->first == name) survivors[cell] = next->second;
  }
  return survivors;
}

}  // namespace

Eigen::Matrix3Xd unknown_places(const BuiltNetwork& built) {
  Eigen::Matrix3Xd places(3, built.unknowns.count);
  for (int p = 0; p < built.network.pores(); ++p) {
    const int unknown = built.unknowns.of_pore[p];
    if (unknown != Unknowns::imposed) places.col(unknown) = built.network.pore_centres.col(p);
  }
  return places;
}

Loads loads_of(const BuiltNetwork& built, const Eigen::VectorXd& pressures) {
  Loads loads = multiply(*built.force_matrix, pressures);
  const Bases& bases = built.bases;
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0)
      loads.col(spheres_in(loads) + bases.face[b]) += pressures[bases.pore[b]] * bases.load(b);
  return loads;
}

void rates_of(const BuiltNetwork& built, const Motion& motion, Team& team, Eigen::VectorXd& rates) {
  rates.resize(built.network.pores());
  if (built.geometric_rates)
    volume_rates(*built.geometric_rates, motion, team, rates);
  else
    reciprocal_rates(*built.force_matrix, *built.sum_order, built.bases, motion, team, rates);
}

Eigen::VectorXd gross_rates(const BuiltNetwork& built, const Motion& motion) {
  const int pores = built.network.pores();
  if (built.geometric_rates) return gross_rates(*built.geometric_rates, motion);
  if (!built.force_matrix) return Eigen::VectorXd::Zero(pores);
  return gross_rates(*built.force_matrix, built.bases, motion, pores);
}

Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, const Eigen::VectorXd& sources) {
  return homogeneous_pressures(built, *built.solver, sources);
}

Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, LinearSolver& solver,
                                      const Eigen::VectorXd& sources) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(built.unknowns.count), x = b;
  const auto& unknown = built.unknowns.of_pore;
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) b[unknown[p]] += sources[static_cast<Eigen::Index>(p)];
  if (built.unknowns.count > 0) solver.solve(b, x);
  Eigen::VectorXd pressures = Eigen::VectorXd::Zero(sources.size());
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) pressures[static_cast<Eigen::Index>(p)] = x[unknown[p]];
  return pressures;
}

CellExtents cell_extents(const PoreNetwork& network, const Spheres& spheres, int axis) {
  CellExtents extents;
  for (const auto& cell : network.cell_vertices) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vertex vertex : cell) {
      if (is_wall(vertex) && wall_number(vertex) / 2 != axis) continue;
      const double x = !is_wall(vertex)             ? spheres.centres(axis, vertex)
                       : wall_number(vertex) % 2 != 0 ? spheres.edges[axis]
                                                      : 0.0;
      low = std::min(low, x);
      high = std::max(high, x);
    }
    extents.low.push_back(low);
    extents.high.push_back(high);
  }
  return extents;
}

std::vector<double> strain_volumes(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres) {
  std::vector<double> smallest(network.pores(), std::numeric_limits<double>::infinity());
  for (int c = 0; c < network.cells(); ++c)
    for (const Vertex vertex : network.cell_vertices[c])
      if (!is_wall(vertex)) {
        double& radius = smallest[network.cell_pore[c]];
        radius = std::min(radius, spheres.radii[vertex]);
      }
  std::vector<double> volumes(throats.pore_fluid_volume);
  for (int p = 0; p < network.pores(); ++p)
    volumes[p] = std::max(volumes[p], 0.01 * 4.0 / 3.0 * pi * std::pow(smallest[p], 3));
  return volumes;
}

Eigen::VectorXd storage_volumes(const Throats& throats) {
  Eigen::VectorXd volumes(static_cast<Eigen::Index>(throats.pore_volume.size()));
  for (std::size_t p = 0; p < throats.pore_volume.size(); ++p)
    volumes[static_cast<Eigen::Index>(p)] =
        std::max(throats.pore_fluid_volume[p], 0.01 * throats.pore_volume[p]);
  return volumes;
}

Eigen::VectorXd carried_pressures(const BuiltNetwork& old, const Eigen::VectorXd& old_values,
                                  const BuiltNetwork& now) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(now.network.pores());
  if (old.network.cells() == 0 || now.network.pores() == 0) return values;
  // a cell that survives keeps its pressure: its dual vertex need not lie in it, so its place is no
  // guide to it
  const std::vector<int> survivors = surviving_cells(old, now);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(now.network.pores());
  Eigen::VectorXi count = Eigen::VectorXi::Zero(now.network.pores());
  for (int c = 0; c < now.network.cells(); ++c)
    if (survivors[c] >= 0) {
      sum[now.network.cell_pore[c]] += old_values[old.network.cell_pore[survivors[c]]];
      ++count[now.network.cell_pore[c]];
    }
  int cell = 0;
  for (int p = 0; p < now.network.pores(); ++p) {
    if (count[p] > 0) {
      values[p] = sum[p] / count[p];
      continue;
    }
    const Eigen::Vector3d place =
        (now.network.origin + now.network.pore_centres.col(p) - old.network.origin)
            .cwiseMax(0.0)
            .cwiseMin(old.vertices.edges);
    cell = locate(old.network, old.vertices, place, cell);
    values[p] = old_values[old.network.cell_pore[cell]];
  }
  // the sum of V^f p is what the storage term conserves (thesis eq. 4.8 with compressibility)
  const Eigen::VectorXd before = storage_volumes(old.throats);
  const Eigen::VectorXd after = storage_volumes(now.throats);
  values.array() += (before.dot(old_values) - after.dot(values)) / after.sum();
  return values;
}

}  // namespace pfv
