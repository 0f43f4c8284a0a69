// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef PFV_WITH_MUMPS
#include "solve/mumps_solver.hpp"

#include "sparse/sparse_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pfv {

void MumpsSolver::analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd&) {
  factor_.reset();
  pattern_.row_begin = matrix.row_begin;
  pattern_.column = matrix.column;
  find_names();
  together([&] { find_told(matrix); });
  factor_.emplace(ranks());
  factor_->analyse(rows_ ? static_cast<int>(rows_->total + static_cast<std::int64_t>(rows_->borders.size())) : size(), half_);
}

bool MumpsSolver::has_pattern_of(const SymmetricMatrix& matrix) const {
  return matrix.row_begin == pattern_.row_begin && matrix.column == pattern_.column;
}

void MumpsSolver::find_names() {
  name_.resize(static_cast<std::size_t>(size()));
  is_border_.assign(name_.size(), 0);
  std::iota(name_.begin(), name_.end(), 0);
  if (!rows_) return;
  for (int row = 0; row < size(); ++row) name_[row] = static_cast<int>(rows_->name_of(row));
  for (const int border : rows_->borders)
    if (border >= 0) is_border_[border] = 1;
}

/// Own rows, and what this rank has of the conductances among borders, which all add up; of both the half to the right of
/// the diagonal, where borders come last.
void MumpsSolver::find_told(const SymmetricMatrix& matrix) {
  told_.clear();
  half_ = {};
  for (int row = 0; row < size(); ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      const int column = matrix.column[k];
      if (!is_own(row) && !(is_border_[row] && is_border_[column])) continue;
      if (name_[column] < 0)
        fail("a pore of this rank leads to one whose owner is not known: please report this; a run on one rank avoids it");
      if (name_[column] < name_[row]) continue;
      told_.push_back(k);
      half_.row.push_back(name_[row]);
      half_.column.push_back(name_[column]);
    }
}

void MumpsSolver::factor_values(const SymmetricMatrix& matrix) {
  half_.value.resize(told_.size());
  for (std::size_t e = 0; e < told_.size(); ++e) half_.value[e] = matrix.value[told_[e]];
  factor_->factor(half_);
  refuse_lost_pressures(matrix);
}

/// A 1: own rows, and what this rank has of the borders'.
Eigen::VectorXd MumpsSolver::row_sums(const SymmetricMatrix& matrix) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(size());
  for (int row = 0; row < size(); ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      const int column = matrix.column[k];
      if (is_own(row) || (is_border_[row] && is_border_[column])) sums[row] += matrix.value[k];
      if (is_own(row) && is_border_[column]) sums[column] += matrix.value[k];
    }
  return sums;
}

/// A pivot that is nothing but rounding stops no elimination. Pressures that nothing determines are equal in each group of
/// pores: then the solution of A x = A 1 is not 1.
void MumpsSolver::refuse_lost_pressures(const SymmetricMatrix& matrix) {
  constexpr double lost_digits = 1e-3;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  solve_system(row_sums(matrix), x);
  together([&] {
    for (int row = 0; row < size(); ++row)
      if (is_own(row) && !(std::abs(x[row] - 1.0) < lost_digits)) throw NotPositiveDefinite(row);
  });
}

void MumpsSolver::solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  std::vector<double> all = gathered(b);
  factor_->solve(all);
  hand_out(all, x);
}

/// On the first rank the right-hand sides of all rows, one rank's after the other's as they are numbered, then of borders.
std::vector<double> MumpsSolver::gathered(Eigen::VectorXd b) const {
  if (!rows_) return {b.begin(), b.end()};
  rows_->collect(b);
  std::vector<double> own, at_borders;
  for (int row = 0; row < size(); ++row)
    if (is_own(row)) own.push_back(b[row]);
  for (const int border : rows_->borders) at_borders.push_back(border >= 0 ? b[border] : 0.0);
  rows_->ranks->add(at_borders.data(), at_borders.size());
  std::vector<Ranks::Bytes> to(static_cast<std::size_t>(rows_->ranks->count()));
  append(to.front(), own.data(), own.size());
  std::vector<double> all;
  for (const Ranks::Bytes& of_rank : rows_->ranks->hand_over(to)) {
    const std::vector<double> part = values_in<double>(of_rank);
    all.insert(all.end(), part.begin(), part.end());
  }
  if (rows_->ranks->own() == 0) all.insert(all.end(), at_borders.begin(), at_borders.end());
  return all;
}

void MumpsSolver::hand_out(const std::vector<double>& all, Eigen::VectorXd& x) const {
  if (!rows_) {
    std::copy(all.begin(), all.end(), x.begin());
    return;
  }
  const Ranks& ranks = *rows_->ranks;
  std::vector<Ranks::Bytes> to(static_cast<std::size_t>(ranks.count()));
  if (ranks.own() == 0)
    for (std::size_t r = 0; r < to.size(); ++r) {
      append(to[r], all.data() + rows_->begins[r], static_cast<std::size_t>(rows_->begins[r + 1] - rows_->begins[r]));
      append(to[r], all.data() + rows_->total, rows_->borders.size());
    }
  const std::vector<double> here = values_in<double>(ranks.hand_over(to).front());
  x.setZero();
  auto next = here.begin();
  for (int row = 0; row < size(); ++row)
    if (is_own(row)) x[row] = *next++;
  for (const int border : rows_->borders) {
    if (border >= 0) x[border] = *next;
    ++next;
  }
  rows_->exchange.refresh(ranks, x);
}

}  // namespace pfv
#endif
