// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/cholmod_session.hpp"

#include "sparse/sparse_error.hpp"

#include <string>

namespace pfv {

CholmodSession::CholmodSession() {
  cholmod_start(&common_);
  common_.print = 0;
  common_.error_handler = nullptr;
  common_.nmethods = 1;
  common_.postorder = 1;
  common_.supernodal = CHOLMOD_SUPERNODAL;
}

cholmod_factor* CholmodSession::analyze(const SymmetricRows& matrix,
                                        const std::vector<int>& permutation) {
  cholmod_sparse view = view_of(matrix);
  common_.method[0].ordering = permutation.empty() ? CHOLMOD_AMD : CHOLMOD_GIVEN;
  cholmod_factor* const factor =
      cholmod_analyze_p(&view, const_cast<int*>(permutation.data()), nullptr, 0, &common_);
  require_success("symbolic factorisation");
  return factor;
}

void CholmodSession::require_success(const char* phase) const {
  if (common_.status == CHOLMOD_OK) return;
  if (common_.status == CHOLMOD_OUT_OF_MEMORY) {
    throw SparseError(std::string(phase) + " ran out of memory; use fewer spheres, more memory, or "
                      "metis where the ordering is amd");
  }
  if (common_.status == CHOLMOD_TOO_LARGE) {
    throw SparseError(std::string(phase) + ": the factor has more entries than a 32-bit integer "
                      "counts; use fewer spheres, or metis where the ordering is amd");
  }
  throw SparseError(std::string(phase) + " failed with CHOLMOD's status " +
                    std::to_string(common_.status));
}

cholmod_sparse CholmodSession::view_of(const SymmetricRows& matrix) {
  cholmod_sparse view{};
  view.nrow = view.ncol = matrix.size;
  view.nzmax = matrix.row_begin[matrix.size];
  view.p = const_cast<int*>(matrix.row_begin);
  view.i = const_cast<int*>(matrix.column);
  view.x = const_cast<double*>(matrix.value);
  view.stype = 1;  // CHOLMOD reads the upper triangle and skips the lower one
  view.itype = CHOLMOD_INT;
  view.xtype = matrix.value ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

}  // namespace pfv
