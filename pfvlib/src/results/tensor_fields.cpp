// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/tensor_fields.hpp"

#include "geometry/tensor_rows.hpp"

#include <cmath>
#include <utility>

namespace pfv {

std::vector<Field> tensor_fields(const std::string& name, SphereTensors tensors, double factor) {
  Eigen::RowVectorXd deviators(tensors.cols());
  for (Eigen::Index k = 0; k < tensors.cols(); ++k) deviators[k] = std::sqrt(factor) * deviator_norm(tensors.col(k));
  tensors.row(4).swap(tensors.row(5));  // VTK's order: ... xy, yz, xz
  return {{name, std::move(tensors)}, {name + "_deviator", std::move(deviators)}};
}

std::vector<Field> stress_fields(const std::string& name, SphereTensors stresses) {
  return tensor_fields(name, std::move(stresses), 3.0 / 2.0);
}

}  // namespace pfv
