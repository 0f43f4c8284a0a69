// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/symmetric_matrix.hpp"

namespace pfv {

Eigen::VectorXd multiply(const SymmetricMatrix& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd product(matrix.size());
  for (int row = 0; row < matrix.size(); ++row) {
    double sum = 0.0;
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      sum += matrix.value[k] * x[matrix.column[k]];
    }
    product[row] = sum;
  }
  return product;
}

}  // namespace pfv
