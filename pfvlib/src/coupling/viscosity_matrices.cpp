// SPDX-License-Identifier: GPL-3.0-or-later
// The fluid's resistance to the motion of one sphere alone.
#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <string>

namespace pfv {

namespace {

/// S_k p, N.
Eigen::Vector3d row_times(const ForceMatrix& matrix, int row, const Eigen::VectorXd& pressures) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int i = matrix.row_begin[row]; i < matrix.row_begin[row + 1]; ++i)
    force += matrix.value.col(i).head<3>() * pressures[matrix.pore[i]];
  return force;
}

}  // namespace

std::vector<Eigen::Matrix3d> FlowData::viscosity_matrices(const std::vector<int>& columns) {
  const auto count = static_cast<int>(packing_ids.size());
  for (const int column : columns)
    if (column < 0 || column >= count)
      throw InputError("viscosity matrices: no sphere " + std::to_string(column) +
                       " in a packing of " + std::to_string(count) + " (counted from 0)");
  std::vector<Eigen::Matrix3d> result(columns.size(), Eigen::Matrix3d::Zero());
  const int spheres = built->grains.spheres.size();
  if (spheres == 0) return result;
  make_force_matrices(*built, options, *team, counts);
  make_volume_rates(*built, options, *team, counts);
  const std::vector<int>& active = built->grains.columns;
  Motion alone = Motion::Zero(6, spheres + 6);
  Eigen::VectorXd opened;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto found = std::lower_bound(active.begin(), active.end(), columns[c]);
    if (found == active.end() || *found != columns[c]) continue;  // left out: no fluid around it
    const auto k = static_cast<int>(found - active.begin());
    for (int axis = 0; axis < 3; ++axis) {
      alone(axis, k) = 1.0;
      rates_of(*built, alone, *team, opened);
      result[c].col(axis) =
          row_times(*built->force_matrix, k, homogeneous_pressures(*built, opened)) -
          shear_forces_of(alone).col(k).head<3>();
      alone(axis, k) = 0.0;
    }
  }
  return result;
}

}  // namespace pfv
