// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/borders.hpp"

#include <utility>

namespace pfv {

void Borders::take(const SymmetricMatrix& matrix, const RowShare& rows) {
  const int count = static_cast<int>(rows.borders.size());
  std::vector<int> border(static_cast<std::size_t>(matrix.size()), -1);
  for (int s = 0; s < count; ++s)
    if (rows.borders[s] >= 0) border[rows.borders[s]] = s;
  columns_.assign(count, Eigen::VectorXd::Zero(matrix.size()));
  solutions_.clear();
  among_.setZero(count, count);
  for (int row = 0; row < matrix.size() && count > 0; ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      const int column = border[matrix.column[k]];
      if (column < 0) continue;
      if (border[row] >= 0) among_(border[row], column) += matrix.value[k];
      else if (rows.own[row]) columns_[column][row] = matrix.value[k];
    }
  if (count > 0) rows.ranks->add(among_.data(), static_cast<std::size_t>(among_.size()));
}

Eigen::VectorXd Borders::products(const Eigen::VectorXd& v, const RowShare& rows) const {
  Eigen::VectorXd sums(count());
  for (int s = 0; s < count(); ++s) sums[s] = columns_[s].dot(v);
  rows.ranks->add(sums.data(), static_cast<std::size_t>(sums.size()));
  return sums;
}

bool Borders::take_solutions(std::vector<Eigen::VectorXd> solutions, const RowShare& rows) {
  constexpr double rounding = 1e-12;  // of what a border conducts in all
  solutions_ = std::move(solutions);
  Eigen::MatrixXd own = among_;
  for (int s = 0; s < count(); ++s) own.col(s) -= products(solutions_[s], rows);
  if (!(among_.diagonal().array() > 0.0).all() || !own.allFinite()) return false;
  const Eigen::VectorXd scale = among_.diagonal().cwiseSqrt().cwiseInverse();
  factor_.setThreshold(rounding);
  if (!factor_.compute(scale.asDiagonal() * own * scale.asDiagonal()).isInvertible()) return false;
  factor_.compute(own);
  return true;
}

Eigen::VectorXd Borders::take_out(Eigen::VectorXd& b, const RowShare& rows) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(count());
  for (int s = 0; s < count(); ++s)
    if (rows.borders[s] >= 0) std::swap(sums[s], b[rows.borders[s]]);
  if (count() > 0) rows.ranks->add(sums.data(), static_cast<std::size_t>(sums.size()));
  return sums;
}

void Borders::begin(Eigen::VectorXd& x, const RowShare& rows) const {
  if (count() == 0) return;
  Eigen::VectorXd pressures = Eigen::VectorXd::Zero(count());
  for (int s = 0; s < count(); ++s)
    if (rows.borders[s] >= 0) std::swap(pressures[s], x[rows.borders[s]]);
  // a rank without pores at a border has no entry for its pressure
  Eigen::VectorXd negative = -pressures;
  rows.ranks->take_largest(pressures.data(), static_cast<std::size_t>(count()));
  rows.ranks->take_largest(negative.data(), static_cast<std::size_t>(count()));
  for (int s = 0; s < count(); ++s)
    x += solutions_[s] * (pressures[s] > 0.0 ? pressures[s] : -negative[s]);
}

void Borders::put_in(const Eigen::VectorXd& right_side, Eigen::VectorXd& x, const RowShare& rows) const {
  if (count() == 0) return;
  const Eigen::VectorXd pressures = factor_.solve(right_side - products(x, rows));
  for (int s = 0; s < count(); ++s) x -= solutions_[s] * pressures[s];
  for (int s = 0; s < count(); ++s)
    if (rows.borders[s] >= 0) x[rows.borders[s]] = pressures[s];
}

}  // namespace pfv
