// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/supernodal_factor.hpp"
#include "solve/supernodal_solve.hpp"

#include <cholmod.h>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

namespace pfv {

/// The supernodal factorisation P A P^T = L L^T, symbolically by CHOLMOD, and solves with it.
/// Silent; every failure is a SolverError.
class CholmodFactor {
 public:
  /// `single`: see SupernodalSolve.
  explicit CholmodFactor(bool single = false);
  ~CholmodFactor();
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  /// Symbolic factorisation. `permutation` lists the rows in the order of their elimination and is
  /// postordered here; empty: CHOLMOD's own AMD.
  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation);
  /// L for the values of a matrix with the analysed pattern. Throws where the matrix is not
  /// positive definite, or so nearly singular that rounding has used up every digit of a pivot.
  void factorize(const SymmetricRows& matrix, Team& team);
  /// x = A^-1 b.
  void solve(const double* b, double* x, Team& team) { solve_.solve(b, x, team); }
  /// Stored entries of the analysed L, with the zeros that relaxed supernodes take in.
  std::size_t entries() const { return solve_.entries(); }

 private:
  void make_room();
  void require_success(const char* phase) const;
  [[noreturn]] void throw_out_of_memory(const char* phase) const;
  [[noreturn]] void throw_not_positive_definite(int row) const;

  mutable cholmod_common common_;
  cholmod_factor* symbolic_ = nullptr;
  SupernodalFactor numeric_;
  SupernodalSolve solve_;
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  std::unique_ptr<double[], Free> values_;  ///< of L
  std::size_t room_ = 0;                    ///< bytes of them
};

}  // namespace pfv
