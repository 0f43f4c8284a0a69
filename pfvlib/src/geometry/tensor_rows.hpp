// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace pfv {

using TensorRows = Eigen::Matrix<double, 6, 1>;

/// Of the symmetric part: xx, yy, zz, xy, xz, yz, LIGGGHTS' order.
inline TensorRows tensor_rows(const Eigen::Matrix3d& tensor) {
  const Eigen::Matrix3d s = 0.5 * (tensor + tensor.transpose());
  TensorRows rows;
  rows << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2);
  return rows;
}

/// sqrt(e:e) of the deviator e = t - (t:1) 1/3.
inline double deviator_norm(const TensorRows& tensor) {
  const double mean = tensor.head<3>().mean();
  return std::sqrt((tensor.head<3>().array() - mean).square().sum() + 2.0 * tensor.tail<3>().squaredNorm());
}

}  // namespace pfv
