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
    force += matrix.value.col(i) * pressures[matrix.pore[i]];
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
  make_volume_rates(*built);
  const ForceMatrix columns_of_rates = energy_force_matrix(*built->volume_rate_matrix, spheres);
  const std::vector<int>& active = built->grains.columns;
  Eigen::VectorXd opened = Eigen::VectorXd::Zero(built->network.pores());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto found = std::lower_bound(active.begin(), active.end(), columns[c]);
    if (found == active.end() || *found != columns[c]) continue;  // left out: no fluid around it
    const auto k = static_cast<int>(found - active.begin());
    for (int axis = 0; axis < 3; ++axis) {
      opened.setZero();
      for (int i = columns_of_rates.row_begin[k]; i < columns_of_rates.row_begin[k + 1]; ++i)
        opened[columns_of_rates.pore[i]] += columns_of_rates.value(axis, i);
      result[c].col(axis) =
          row_times(*built->force_matrix, k, homogeneous_pressures(*built, opened));
      if (!built->shear_pairs) continue;
      Eigen::Matrix3Xd motion = Eigen::Matrix3Xd::Zero(3, spheres + 6);
      motion(axis, k) = 1.0;
      result[c].col(axis) -= shear_forces_of(motion).col(k);
    }
  }
  return result;
}

}  // namespace pfv
