// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholesky_factor.hpp"
#include "sparse/cholesky.hpp"
#include "sparse/cholmod_session.hpp"
#include "sparse/sparse_error.hpp"

#include <algorithm>

namespace pfv {
namespace {

/// CHOLMOD from end to end, with its own settings.
class CholmodCholesky final : public CholeskyFactor {
 public:
  CholmodCholesky() = default;
  CholmodCholesky(const CholmodCholesky&) = delete;
  CholmodCholesky& operator=(const CholmodCholesky&) = delete;
  ~CholmodCholesky() override {
    cholmod_free_factor(&factor_, session_);
    for (cholmod_dense** array : {&solution_, &work_, &more_work_})
      cholmod_free_dense(array, session_);
  }

  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) override {
    cholmod_free_factor(&factor_, session_);
    factor_ = session_.analyze(matrix, permutation);
  }

  void factorize(const SymmetricRows& matrix, Team&) override {
    cholmod_sparse view = CholmodSession::view_of(matrix);
    cholmod_factorize(&view, factor_, session_);
    const auto* order = static_cast<const int*>(factor_->Perm);
    if (session_->status == CHOLMOD_NOT_POSDEF) throw NotPositiveDefinite(order[factor_->minor]);
    session_.require_success("numeric factorisation");
    const int lost = lost_column(matrix);
    if (lost >= 0) throw NotPositiveDefinite(order[lost]);
  }

  void solve(const double* b, double* x, Team&) override {
    cholmod_dense right_side{};
    right_side.nrow = right_side.nzmax = right_side.d = factor_->n;
    right_side.ncol = 1;
    right_side.x = const_cast<double*>(b);
    right_side.xtype = CHOLMOD_REAL;
    right_side.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &right_side, nullptr, &solution_, nullptr, &work_, &more_work_,
                   session_);
    session_.require_success("solve");
    const auto* values = static_cast<const double*>(solution_->x);
    std::copy(values, values + factor_->n, x);
  }

  std::size_t entries() const override { return factor_ ? factor_->xsize : 0; }
  bool bears_other_threads() const override { return false; }

 private:
  /// The first column whose pivot is nothing but rounding: CHOLMOD asks only whether it is positive.
  int lost_column(const SymmetricRows& matrix) const {
    const auto* first = static_cast<const int*>(factor_->super);
    const auto* rows_begin = static_cast<const int*>(factor_->pi);
    const auto* values_begin = static_cast<const int*>(factor_->px);
    const auto* order = static_cast<const int*>(factor_->Perm);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const int height = rows_begin[s + 1] - rows_begin[s];
      const double* pivot = static_cast<const double*>(factor_->x) + values_begin[s];
      for (int column = first[s]; column < first[s + 1]; ++column, pivot += height + 1) {
        const int row = order[column];
        const int* const begin = matrix.column + matrix.row_begin[row];
        const int* const end = matrix.column + matrix.row_begin[row + 1];
        const double diagonal = matrix.value[std::lower_bound(begin, end, row) - matrix.column];
        if (!(*pivot * *pivot > SparseCholesky::lost_pivot * diagonal)) return column;
      }
    }
    return -1;
  }

  CholmodSession session_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_ = nullptr;
  cholmod_dense* more_work_ = nullptr;
};

}  // namespace

std::shared_ptr<CholeskyFactor> make_cholmod_cholesky() {
  return std::make_shared<CholmodCholesky>();
}

}  // namespace pfv
