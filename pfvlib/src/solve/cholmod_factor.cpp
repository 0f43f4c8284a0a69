// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholmod_factor.hpp"

#include "pfv/error.hpp"

#include <string>
#include <sys/mman.h>

namespace pfv {
namespace {

/// A pivot that elimination has shrunk below this part of its diagonal entry is rounding error.
/// Measured on lattices of 216 to 46656 unknowns: ungrounded ones leave up to 2e-13 (conductances
/// over ten decades), grounded ones at least 1e-7.
constexpr double lost_pivot = 1e-12;

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

}  // namespace

CholmodFactor::CholmodFactor(bool single) : solve_(single) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.error_handler = nullptr;
  common_.nmethods = 1;
  common_.postorder = 1;
  common_.supernodal = CHOLMOD_SUPERNODAL;
  // Small supernodes merge where less than these parts of the result are zeros: less than CHOLMOD's
  // own (0.8, 0.1, 0.05), because solves read the zeros too. Measured at 20000 spheres: 6 % less to
  // read, the factorisation as fast.
  common_.zrelax[0] = 0.5;
  common_.zrelax[1] = 0.05;
  common_.zrelax[2] = 0.02;
}

CholmodFactor::~CholmodFactor() {
  cholmod_free_factor(&symbolic_, &common_);
  cholmod_finish(&common_);
}

void CholmodFactor::analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) {
  cholmod_free_factor(&symbolic_, &common_);
  cholmod_sparse view = as_cholmod(matrix);
  common_.method[0].ordering = permutation.empty() ? CHOLMOD_AMD : CHOLMOD_GIVEN;
  symbolic_ = cholmod_analyze_p(&view, const_cast<int*>(permutation.data()), nullptr, 0, &common_);
  require_success("symbolic factorisation");
  const Supernodes supernodes(*symbolic_);
  const SubtreeCut cut = cut_elimination_tree(supernodes);
  const auto* order = static_cast<const int*>(symbolic_->Perm);
  numeric_.analyze(supernodes, cut, order);
  solve_.analyze(supernodes, cut, numeric_.blocks(), order);
}

// The room of an earlier matrix does for the next one of about its size: on virtual machines the first
// touch of memory can take as long as the factorisation. What is spare is never touched. In huge pages
// the solves are up to a fifth faster at 20000 spheres.
void CholmodFactor::make_room() {
  constexpr double spare = 0.05;
  constexpr std::size_t huge_page = std::size_t{1} << 21;
  std::size_t bytes = (numeric_.size() + SupernodalSolve::margin) * sizeof(double);
  if (bytes <= room_ && room_ <= 2 * bytes) return;
  values_.reset();
  room_ = 0;
  bytes += static_cast<std::size_t>(spare * static_cast<double>(bytes));
  const std::size_t alignment = bytes < 2 * huge_page ? 64 : huge_page;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  values_.reset(static_cast<double*>(std::aligned_alloc(alignment, whole)));
  if (!values_) throw_out_of_memory("numeric factorisation");
  room_ = whole;
#ifdef MADV_HUGEPAGE
  if (alignment == huge_page) madvise(values_.get(), whole, MADV_HUGEPAGE);
#endif
}

void CholmodFactor::factorize(const SymmetricRows& matrix, Team& team) {
  make_room();
  const int lost = numeric_.factorize(matrix, lost_pivot, values_.get(), team);
  if (lost != SupernodalFactor::none)
    throw_not_positive_definite(static_cast<const int*>(symbolic_->Perm)[lost]);
  solve_.pack(numeric_.blocks(), values_.get());
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
      numeric_.size() > 0 ? " (the factor takes " +
                                std::to_string(numeric_.size() * sizeof(double) >> 20) + " MiB)"
              : "";
  throw SolverError(std::string("cholmod: ") + phase + " ran out of memory" + need +
                    "; use fewer spheres, more memory, or metis where the ordering is amd");
}

void CholmodFactor::throw_not_positive_definite(int row) const {
  throw SolverError("cholmod: the matrix is not positive definite at row " + std::to_string(row) +
                    ": nothing determines the pressure of a group of pores, or a conductance is "
                    "negative; impose a pressure on a face or patch that the group reaches");
}

}  // namespace pfv
