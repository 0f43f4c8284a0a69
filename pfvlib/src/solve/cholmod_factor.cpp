// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholmod_factor.hpp"

#include "pfv/error.hpp"

#include <cstdlib>
#include <mutex>
#include <omp.h>
#include <string>
#include <sys/mman.h>

namespace pfv {
namespace {

/// A pivot that elimination has shrunk below this part of its diagonal entry is rounding error.
/// Measured on lattices of 216 to 46656 unknowns: ungrounded ones leave up to 2e-13 (conductances
/// over ten decades), grounded ones at least 1e-7.
constexpr double lost_pivot = 1e-12;

/// Keeps CHOLMOD from opening a team of four threads for each supernode, as Debian's build does
/// whatever OMP_NUM_THREADS says: supernodes are too small to gain from it, and waiting threads
/// take the cores of the other ranks. And only one factorisation of the process runs at a time: a
/// BLAS for one thread (Debian's openblas-serial) mixes up the work space of two that call it
/// together, and returns wrong factors.
class OneThread {
 public:
  OneThread() : turn_(factorisation()) { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  static std::mutex& factorisation() {
    static std::mutex mutex;
    return mutex;
  }

  std::lock_guard<std::mutex> turn_;
  int levels_ = omp_get_max_active_levels();
};

cholmod_sparse as_cholmod(const SymmetricRows& matrix) {
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

double diagonal_entry(const SymmetricRows& matrix, int row) {
  for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
    if (matrix.column[k] == row) return matrix.value[k];
  }
  return 0.0;
}

}  // namespace

CholmodFactor::CholmodFactor(bool single) : solve_(single) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.error_handler = nullptr;
  common_.nmethods = 1;
  common_.postorder = 1;
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.quick_return_if_not_posdef = 1;
  // Small supernodes merge where less than these parts of the result are zeros: less than CHOLMOD's
  // own (0.8, 0.1, 0.05), because solves read the zeros too. Measured at 20000 spheres: 6 % less to
  // read, the factorisation as fast.
  common_.zrelax[0] = 0.5;
  common_.zrelax[1] = 0.05;
  common_.zrelax[2] = 0.02;
}

CholmodFactor::~CholmodFactor() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

void CholmodFactor::analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) {
  cholmod_free_factor(&factor_, &common_);
  cholmod_sparse view = as_cholmod(matrix);
  common_.method[0].ordering = permutation.empty() ? CHOLMOD_AMD : CHOLMOD_GIVEN;
  factor_ = cholmod_analyze_p(&view, const_cast<int*>(permutation.data()), nullptr, 0, &common_);
  require_success("symbolic factorisation");
  solve_.analyze(*factor_);
}

// CHOLMOD takes values that are there already, and frees them with the factor. In huge pages the
// solves are up to a fifth faster at 20000 spheres.
void CholmodFactor::allocate_values() {
  if (factor_->x) return;
  constexpr std::size_t huge_page = std::size_t{1} << 21;
  const std::size_t bytes = (factor_->xsize + SupernodalSolve::margin) * sizeof(double);
  const std::size_t alignment = bytes < 2 * huge_page ? 64 : huge_page;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  factor_->x = std::aligned_alloc(alignment, whole);
  if (!factor_->x) throw_out_of_memory("numeric factorisation");
  factor_->xtype = CHOLMOD_REAL;
#ifdef MADV_HUGEPAGE
  if (alignment == huge_page) madvise(factor_->x, whole, MADV_HUGEPAGE);
#endif
}

void CholmodFactor::factorize(const SymmetricRows& matrix) {
  const OneThread one_thread;
  allocate_values();
  cholmod_sparse view = as_cholmod(matrix);
  cholmod_factorize(&view, factor_, &common_);
  if (common_.status == CHOLMOD_NOT_POSDEF) {
    throw_not_positive_definite(static_cast<const int*>(factor_->Perm)[factor_->minor]);
  }
  require_success("numeric factorisation");
  require_positive_pivots(matrix);
  solve_.pack(*factor_);
}

void CholmodFactor::require_success(const char* phase) const {
  if (common_.status == CHOLMOD_OK) return;
  if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw_out_of_memory(phase);
  const std::string what = std::string("cholmod: ") + phase;
  if (common_.status == CHOLMOD_TOO_LARGE) {
    throw SolverError(what + ": the factor has more entries than a 32-bit integer counts; use "
                      "fewer spheres, or metis where the ordering is amd");
  }
  throw SolverError(what + " failed with status " + std::to_string(common_.status));
}

void CholmodFactor::throw_out_of_memory(const char* phase) const {
  const std::string need =
      factor_ ? " (the factor takes " + std::to_string(factor_->xsize * sizeof(double) >> 20) +
                    " MiB)"
              : "";
  throw SolverError(std::string("cholmod: ") + phase + " ran out of memory" + need +
                    "; use fewer spheres, more memory, or metis where the ordering is amd");
}

// L is stored by supernodes: columns super[s] ... super[s + 1] share the pi[s + 1] - pi[s] rows of
// a dense block that starts at px[s], diagonal first.
void CholmodFactor::require_positive_pivots(const SymmetricRows& matrix) const {
  const auto* first_column = static_cast<const int*>(factor_->super);
  const auto* rows_begin = static_cast<const int*>(factor_->pi);
  const auto* block_begin = static_cast<const int*>(factor_->px);
  const auto* permutation = static_cast<const int*>(factor_->Perm);
  const auto* value = static_cast<const double*>(factor_->x);
  for (std::size_t s = 0; s < factor_->nsuper; ++s) {
    const std::size_t leading_dimension = rows_begin[s + 1] - rows_begin[s];
    const double* diagonal = value + block_begin[s];
    for (int column = first_column[s]; column < first_column[s + 1]; ++column) {
      const int row = permutation[column];
      if (!(*diagonal * *diagonal > lost_pivot * diagonal_entry(matrix, row))) {
        throw_not_positive_definite(row);
      }
      diagonal += leading_dimension + 1;
    }
  }
}

void CholmodFactor::throw_not_positive_definite(int row) const {
  throw SolverError("cholmod: the matrix is not positive definite at row " + std::to_string(row) +
                    ": nothing determines the pressure of a group of pores, or a conductance is "
                    "negative; impose a pressure on a face or patch that the group reaches");
}

}  // namespace pfv
