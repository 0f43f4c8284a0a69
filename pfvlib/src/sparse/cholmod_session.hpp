// SPDX-License-Identifier: GPL-3.0-or-later
// For sources that call CHOLMOD; no other header of this folder includes it.
#pragma once

#include "sparse/symmetric_matrix.hpp"

#include <cholmod.h>
#include <vector>

namespace pfv {

/// CHOLMOD's settings and state, silent: what it has to say is a SparseError.
class CholmodSession {
 public:
  CholmodSession();
  ~CholmodSession() { cholmod_finish(&common_); }
  CholmodSession(const CholmodSession&) = delete;
  CholmodSession& operator=(const CholmodSession&) = delete;

  cholmod_common* operator->() { return &common_; }
  operator cholmod_common*() { return &common_; }

  /// Supernodal symbolic factor. `permutation` lists the rows in the order of their elimination and is
  /// postordered here; empty: CHOLMOD's own AMD.
  cholmod_factor* analyze(const SymmetricRows& matrix, const std::vector<int>& permutation);
  /// Throws where the last call failed.
  void require_success(const char* phase) const;
  /// The matrix where it lies.
  static cholmod_sparse view_of(const SymmetricRows& matrix);

 private:
  cholmod_common common_;
};

}  // namespace pfv
