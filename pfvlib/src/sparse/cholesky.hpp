// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse/supernodal_factor.hpp"
#include "sparse/supernodal_solve.hpp"
#include "sparse/symbolic_factor.hpp"

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

namespace pfv {

/// The supernodal factorisation P A P^T = L L^T and solves with it; or L D L^T, D = 1 or -1, of a matrix that is
/// quasi-definite: [H S; S^T -G] with H and G positive definite has such a factor in any order (Vanderbei 1995, SIAM
/// J. Optim. 5). Silent; every failure is a SparseError.
class SparseCholesky {
 public:
  /// `single`: see SupernodalSolve.
  explicit SparseCholesky(bool single = false) : solve_(single) {}
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// Symbolic factorisation. `permutation`: see SymbolicFactor.
  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation);
  /// L for the values of a matrix with the analysed pattern. Throws NotPositiveDefinite, also where the
  /// matrix is so nearly singular that rounding has used up every digit of a pivot.
  /// `signs` of the pivots by rows of the matrix, 1 or -1; none: all are positive.
  void factorize(const SymmetricRows& matrix, Team& team, const std::vector<double>& signs = {});
  /// x = A^-1 b.
  void solve(const double* b, double* x, Team& team) { solve_.solve(b, x, team); }
  /// Stored entries of the analysed L, with the zeros that relaxed supernodes take in.
  std::size_t entries() const { return solve_.entries(); }

  /// A pivot that elimination has shrunk below this part of its diagonal entry is rounding error.
  /// Measured on lattices of 216 to 46656 unknowns: ungrounded ones leave up to 2e-13 (conductances
  /// over ten decades), grounded ones at least 1e-7.
  static constexpr double lost_pivot = 1e-12;

 private:
  void make_room();

  SymbolicFactor symbolic_;
  SupernodalFactor numeric_;
  SupernodalSolve solve_;
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  std::unique_ptr<double[], Free> values_;  ///< of L
  std::size_t room_ = 0;                    ///< bytes of them
};

}  // namespace pfv
