// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/cholesky.hpp"

#include "sparse/sparse_error.hpp"

#include <string>
#include <sys/mman.h>
#include <utility>

namespace pfv {

void SparseCholesky::analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) {
  symbolic_.analyze(matrix, permutation);
  const Supernodes& supernodes = symbolic_.supernodes();
  const SubtreeCut cut = cut_elimination_tree(supernodes);
  numeric_.analyze(supernodes, cut, symbolic_.permutation());
  solve_.analyze(supernodes, cut, numeric_.blocks(), symbolic_.permutation());
}

// The room of an earlier matrix does for the next one of about its size: on virtual machines the first
// touch of memory can take as long as the factorisation. What is spare is never touched. In huge pages
// the solves are up to a fifth faster at 20000 spheres.
void SparseCholesky::make_room() {
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
  if (!values_) {
    throw SparseError("numeric factorisation ran out of memory (the factor takes " +
                      std::to_string(whole >> 20) + " MiB); use fewer spheres, more memory, or metis "
                      "where the ordering is amd");
  }
  room_ = whole;
#ifdef MADV_HUGEPAGE
  if (alignment == huge_page) madvise(values_.get(), whole, MADV_HUGEPAGE);
#endif
}

void SparseCholesky::factorize(const SymmetricRows& matrix, Team& team, const std::vector<double>& signs) {
  make_room();
  std::vector<double> in_order(signs.size());
  for (std::size_t k = 0; k < signs.size(); ++k) in_order[k] = signs[symbolic_.permutation()[k]];
  const int lost = numeric_.factorize(matrix, lost_pivot, in_order, values_.get(), team);
  if (lost != SupernodalFactor::none) throw NotPositiveDefinite(symbolic_.permutation()[lost]);
  solve_.pack(numeric_.blocks(), values_.get(), std::move(in_order));
}

}  // namespace pfv
