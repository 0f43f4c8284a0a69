// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <memory>

namespace pfv {

struct RowShare;

/// hypre's BoomerAMG (Henson and Yang 2002) as a symmetric positive definite preconditioner, on the calling rank
/// alone or on those that share the rows. Same matrix, same bytes on the same number of ranks. Starts MPI where the
/// program has not. Threads that have one each take turns, where ranks share none.
class AlgebraicMultigrid {
 public:
  AlgebraicMultigrid();
  ~AlgebraicMultigrid();

  /// Builds the hierarchy; `matrix`: symmetric, a positive diagonal. Throws std::runtime_error with hypre's words.
  /// Cost: some 15 of `apply`; memory: some 270 bytes an unknown.
  /// `rows`: null on one rank; else own rows are taken, without what they have in columns of borders. Collective then.
  void build(const SymmetricMatrix& matrix, const RowShare* rows = nullptr);
  /// z = M^-1 r, one V-cycle from z = 0; of several ranks, in own rows, and 0 in the others.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;
  /// Frees the hierarchy.
  void clear();

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace pfv
