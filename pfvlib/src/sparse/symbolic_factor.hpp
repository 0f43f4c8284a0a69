// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse/elimination_tree.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <memory>
#include <vector>

namespace pfv {

/// The supernodes of P A P^T = L L^T, found by CHOLMOD.
class SymbolicFactor {
 public:
  SymbolicFactor();
  ~SymbolicFactor();
  SymbolicFactor(const SymbolicFactor&) = delete;
  SymbolicFactor& operator=(const SymbolicFactor&) = delete;

  /// `permutation` lists the rows in the order of their elimination and is postordered here; empty:
  /// CHOLMOD's own AMD. Throws SparseError.
  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation);
  /// Until the next `analyze`.
  const Supernodes& supernodes() const { return supernodes_; }
  const int* permutation() const { return permutation_; }

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
  Supernodes supernodes_;
  const int* permutation_ = nullptr;
};

}  // namespace pfv
