// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/stiffest_grain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pfv {

namespace {

constexpr double unknown_stiffness = std::numeric_limits<double>::infinity();

/// g of each pore's unknown, m³/(Pa s); infinite where it is imposed, or known to another rank alone.
Eigen::VectorXd diagonal_of_pores(const BuiltNetwork& built) {
  const SymmetricMatrix& matrix = built.kept.system.matrix;
  std::vector<double> diagonal(built.unknowns.count, unknown_stiffness);
  for (int row = 0; row < matrix.size(); ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k)
      if (matrix.column[k] == row && matrix.value[k] > 0.0) diagonal[row] = matrix.value[k];
  for (const Unknowns::Shared& shared : built.unknowns.shared) diagonal[shared.unknown] = unknown_stiffness;
  Eigen::VectorXd of_pores = Eigen::VectorXd::Constant(built.network.pores(), unknown_stiffness);
  for (int pore = 0; pore < built.network.pores(); ++pore)
    if (const int unknown = built.unknowns.of_pore[pore]; unknown >= 0 && built.share.owns_pore(pore))
      of_pores[pore] = diagonal[unknown];
  if (built.share.ranks) built.share.pores.refresh(*built.share.ranks, of_pores);
  return of_pores;
}

/// The largest |s|² / g over the pressures around a sphere, m kg/s.
double stiffness_of(const BuiltNetwork& built, const ForceMatrix& forces, int sphere, const Eigen::VectorXd& diagonal,
                    std::vector<std::pair<int, int>>& entries) {
  entries.clear();
  for (int k = forces.row_begin[sphere]; k < forces.row_begin[sphere + 1]; ++k)
    if (const int pore = forces.pore[k]; built.unknowns.of_pore[pore] >= 0 && std::isfinite(diagonal[pore]))
      entries.emplace_back(built.unknowns.of_pore[pore], k);
  std::sort(entries.begin(), entries.end());
  double most = 0.0;
  for (std::size_t i = 0; i < entries.size();) {
    const int unknown = entries[i].first;
    const double g = diagonal[forces.pore[entries[i].second]];
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (; i < entries.size() && entries[i].first == unknown; ++i) force += forces.value.col(entries[i].second).head<3>();
    most = std::max(most, force.squaredNorm() / g);
  }
  return most;
}

}  // namespace

StiffestGrain stiffest_grain_of(const BuiltNetwork& built, const Eigen::VectorXd& masses) {
  const ForceMatrix& forces = *built.operators.force_matrix;
  const Eigen::VectorXd diagonal = diagonal_of_pores(built);
  double most = 0.0;
  std::int64_t id = -1;
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < built.grains.spheres.size(); ++i) {
    const bool held = !built.grains.body.empty() && built.grains.body[i] >= 0;
    if (held || !built.share.owns_sphere(i)) continue;
    const double stiffness = stiffness_of(built, forces, i, diagonal, entries) / masses[built.grains.columns[i]];
    if (!(stiffness > most)) continue;
    most = stiffness;
    id = built.grains.spheres.ids[i];
  }
  const double over_all = built.share.largest(most);
  if (!(over_all > 0.0)) return {};
  return {2.0 / over_all, static_cast<std::int64_t>(built.share.largest(most == over_all ? static_cast<double>(id) : -1.0))};
}

}  // namespace pfv
