// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/team.hpp"
#include "pfv/options.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace pfv {

/// P A P^T = L L^T by one of several codes, and solves with it. Failures are a SparseError or what the
/// code itself throws.
class CholeskyFactor {
 public:
  virtual ~CholeskyFactor() = default;
  /// Symbolic factorisation. `permutation` lists the rows in the order of their elimination; empty:
  /// minimum degree.
  virtual void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) = 0;
  /// L for the values of a matrix with the analysed pattern.
  virtual void factorize(const SymmetricRows& matrix, Team& team) = 0;
  /// x = A^-1 b.
  virtual void solve(const double* b, double* x, Team& team) = 0;
  /// Stored entries of L; 0 where the code does not tell.
  virtual std::size_t entries() const = 0;
  /// Whether other threads may factor and solve meanwhile. The BLAS need not bear two threads.
  virtual bool bears_other_threads() const = 0;
};

}  // namespace pfv
