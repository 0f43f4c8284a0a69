// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <memory>

namespace pfv {

/// hypre's BoomerAMG (Henson and Yang 2002) as a symmetric positive definite preconditioner, on the calling rank
/// alone. Same matrix, same bytes. Starts MPI where the program has not; one thread at a time.
class AlgebraicMultigrid {
 public:
  AlgebraicMultigrid();
  ~AlgebraicMultigrid();

  /// Builds the hierarchy; `matrix`: symmetric, a positive diagonal. Throws std::runtime_error with hypre's words.
  /// Cost: some 15 of `apply`; memory: some 270 bytes an unknown.
  void build(const SymmetricMatrix& matrix);
  /// z = M^-1 r, one V-cycle from z = 0.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;
  /// Frees the hierarchy.
  void clear();

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace pfv
