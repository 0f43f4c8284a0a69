// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/viscosity_matrices.hpp"

#include "pfv/error.hpp"
#include "step/operators.hpp"

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

std::vector<Eigen::Matrix3d> viscosity_matrices(BuiltNetwork& built, const Problem& problem,
                                                Eigen::Index packed,
                                                const std::vector<int>& columns, Counts& counts) {
  for (const int column : columns)
    if (column < 0 || column >= packed)
      throw InputError("viscosity matrices: no sphere " + std::to_string(column) +
                       " in a packing of " + std::to_string(packed) + " (counted from 0)");
  std::vector<Eigen::Matrix3d> result(columns.size(), Eigen::Matrix3d::Zero());
  const int spheres = built.grains.spheres.size();
  if (spheres == 0) return result;
  make_force_matrices(built, problem, counts);
  make_volume_rates(built, problem, counts);
  const std::vector<int>& active = built.grains.columns;
  Motion alone = no_motion(spheres, problem.container.face_count());
  Eigen::VectorXd opened;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto found = std::lower_bound(active.begin(), active.end(), columns[c]);
    if (found == active.end() || *found != columns[c]) continue;  // left out: no fluid around it
    const auto k = static_cast<int>(found - active.begin());
    for (int axis = 0; axis < 3; ++axis) {
      alone(axis, k) = 1.0;
      rates_of(built, alone, *problem.team, opened);
      const Eigen::VectorXd pressures = homogeneous_pressures(built, opened, counts.query_solve);
      result[c].col(axis) = row_times(*built.operators.force_matrix, k, pressures) -
                            resisting_forces(built, problem.fluid.viscosity, alone).col(k).head<3>();
      alone(axis, k) = 0.0;
    }
  }
  return result;
}

}  // namespace pfv
