// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <deque>

namespace pfv {

/// A starting vector for the next solve of A x = b, from the last solutions: the last one plus the combination of
/// the changes that led to it whose error is least in the norm of A (Fischer 1998, with the newest changes kept).
class LastSolutions {
 public:
  /// `most`: changes that are kept, each with 8 bytes an unknown.
  explicit LastSolutions(std::size_t most) : most_(most) {}
  /// For another matrix. `ranks`: those that share its rows; null for one.
  void forget(const Ranks* ranks = nullptr);
  /// `x`: the last solution; becomes the beginning for b. `r`: b - A x. Cost: a product with A and three reads of
  /// each change.
  void begin(const SymmetricMatrix& matrix, const Eigen::VectorXd& r, Eigen::VectorXd& x);

 private:
  void remember(const SymmetricMatrix& matrix, const Eigen::VectorXd& x);
  void add(Eigen::VectorXd change, const Eigen::VectorXd& product);

  Eigen::VectorXd products_with(const Eigen::VectorXd& r) const;

  std::size_t most_;
  const Ranks* ranks_ = nullptr;
  Eigen::VectorXd last_;
  std::deque<Eigen::VectorXd> changes_;  ///< from one solution to the next, the first from 0; of length 1 by A
  Eigen::MatrixXd products_;             ///< of each two changes, by A
};

}  // namespace pfv
