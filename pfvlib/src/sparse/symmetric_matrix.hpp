// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Non-owning view of a symmetric matrix in compressed rows with both triangles, columns sorted.
struct SymmetricRows {
  int size = 0;
  const int* row_begin = nullptr;
  const int* column = nullptr;
  const double* value = nullptr;  ///< may be null where only the pattern is wanted
};

/// Symmetric positive definite matrix in compressed rows: both triangles, diagonal present, columns
/// sorted in each row.
struct SymmetricMatrix {
  std::vector<int> row_begin{0};  ///< n + 1
  std::vector<int> column;
  std::vector<double> value;

  int size() const { return static_cast<int>(row_begin.size()) - 1; }
  SymmetricRows rows() const { return {size(), row_begin.data(), column.data(), value.data()}; }
};

/// r = A x.
Eigen::VectorXd multiply(const SymmetricMatrix& matrix, const Eigen::VectorXd& x);

}  // namespace pfv
