// SPDX-License-Identifier: GPL-3.0-or-later
// The pressures of a compressible fluid on a new network.
#include "network/canonical_order.hpp"
#include "network/pore_network.hpp"
#include "step/built_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pfv {

namespace {

/// The name of each cell with its number, by the names.
std::vector<std::pair<CellName, int>> named_cells(const BuiltNetwork& built) {
  std::vector<std::pair<CellName, int>> names(built.network.cells());
  for (int c = 0; c < built.network.cells(); ++c) names[c] = {cell_name(built.network.cell_vertices[c], built.vertices), c};
  std::sort(names.begin(), names.end());
  return names;
}

/// How far a cell has gone, m, and what a macroscopic gradient has raised its pressure by, Pa, where the grains have
/// carried it across the border of a periodic cell: the new network has another image of it at home.
struct Wrapped {
  double length, raised;
};

Wrapped wrapped_way(const BuiltNetwork& old, int before, const BuiltNetwork& now, int after) {
  const Eigen::Vector3d way = now.network.origin + now.network.cell_centres.col(after) - old.network.origin -
                              old.network.cell_centres.col(before);
  const Lattice lattice = now.grains.spheres.lattice();
  const Eigen::Vector3d periods = lattice.displacement(lattice.nearest(way));
  const Eigen::Vector3d& gradient = now.container.pressure_gradient;
  return {(way - periods).norm(), gradient.isZero(0.0) ? 0.0 : gradient.dot(periods)};
}

/// For each cell of `now` the cell of `old` with the same vertices, or -1; of several, which images may have, the one
/// that has moved least.
std::vector<int> surviving_cells(const BuiltNetwork& old, const BuiltNetwork& now) {
  const auto before = named_cells(old), after = named_cells(now);
  std::vector<int> survivors(now.network.cells(), -1);
  auto next = before.begin();
  for (const auto& [name, cell] : after) {
    while (next != before.end() && next->first < name) ++next;
    double least = std::numeric_limits<double>::infinity();
    for (auto same = next; same != before.end() && same->first == name; ++same) {
      const double length = wrapped_way(old, same->second, now, cell).length;
      if (survivors[cell] >= 0 && !(length < least)) continue;
      least = length;
      survivors[cell] = same->second;
    }
  }
  return survivors;
}

}  // namespace

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
      sum[now.network.cell_pore[c]] +=
          old_values[old.network.cell_pore[survivors[c]]] + wrapped_way(old, survivors[c], now, c).raised;
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
