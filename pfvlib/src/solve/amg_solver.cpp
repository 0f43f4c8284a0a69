// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/amg_solver.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pfv {
namespace {

constexpr int most_cycles = 500;
constexpr int first_look = 2;  // iterations from x = 0 after which x tells how much flows
constexpr double drift = 2.0;  // b - A x over its recurrence, from which on the recurrence is of no use
constexpr double lost = 1e-6;  // error of pressures, of the largest, that rounding may cost
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The sum of each row; 0 where it is nothing but rounding.
Eigen::VectorXd row_sums(const SymmetricMatrix& matrix) {
  Eigen::VectorXd sums(matrix.size());
  for (int row = 0; row < matrix.size(); ++row) {
    double sum = 0.0, magnitude = 0.0;
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      sum += matrix.value[k];
      magnitude += std::abs(matrix.value[k]);
    }
    const int entries = matrix.row_begin[row + 1] - matrix.row_begin[row];
    sums[row] = std::abs(sum) > entries * epsilon * magnitude ? sum : 0.0;
  }
  return sums;
}

}  // namespace

void AmgSolver::analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) {
  multigrid_.clear();
  ConjugateGradient::analyze_pattern(matrix, coordinates);
}

void AmgSolver::factor_values(const SymmetricMatrix& matrix) {
  keep_values(matrix);
  held_ = row_sums(matrix);
  refuse_lost_pressures();
  last_.forget();
  multigrid_.build(matrix);
}

/// Conjugate gradients would end at any pressure of a group of pores that nothing holds. A throat that is rounding
/// beside what either of its pores conducts holds none.
void AmgSolver::refuse_lost_pressures() {
  DisjointSets groups(size());
  for (int row = 0; row < size(); ++row)
    for (int k = matrix_.row_begin[row]; k < matrix_.row_begin[row + 1]; ++k)
      if (std::abs(matrix_.value[k]) > 4.0 * epsilon * matrix_.value[diagonal_[row]])
        groups.join(row, matrix_.column[k]);
  std::vector<char> is_held(static_cast<std::size_t>(size()), 0);
  for (int row = 0; row < size(); ++row)
    if (held_[row] != 0.0) is_held[groups.find(row)] = 1;
  for (int row = 0; row < size(); ++row)
    if (!is_held[groups.find(row)]) fail_at(row);
}

void AmgSolver::begin(const Eigen::VectorXd&, Eigen::VectorXd& x) {
  if (!x.allFinite()) x.setZero();
}

/// By differences of pressures, which keep the digits of what flows where pressures are large.
void AmgSolver::measure(const Eigen::VectorXd& b, const Eigen::VectorXd& x, Defect& defect) const {
  defect.r.resize(size());
  double flow = 0.0, magnitude = 0.0;  // squared norms
  for (int row = 0; row < size(); ++row) {
    const double source = b[row] - held_[row] * x[row];
    double net = source, gross = std::abs(source), uncancelled = 0.0;
    for (int k = matrix_.row_begin[row]; k < matrix_.row_begin[row + 1]; ++k) {
      const double there = x[matrix_.column[k]], inflow = -matrix_.value[k] * (there - x[row]);
      net += inflow;
      gross += std::abs(inflow);
      uncancelled += std::abs(matrix_.value[k] * there);
    }
    defect.r[row] = net;
    flow += 0.25 * gross * gross;
    magnitude += uncancelled * uncancelled;
  }
  defect.size = defect.r.norm();
  defect.flow = std::sqrt(flow);
  defect.rounding = 2.0 * epsilon * std::sqrt(magnitude);
}

/// Against the flow, not b: with imposed pressures b is what their throats would carry if all other pressures were
/// 0, in a packing of 20 000 grains two thousand times what flows.
double AmgSolver::tolerated(const Defect& defect) const {
  return std::max(tolerance_ * defect.flow, defect.rounding);
}

/// The error of the pressures is looked at for pores behind throats far narrower than all others: little flow,
/// wrong pressures.
bool AmgSolver::is_solved(const Eigen::VectorXd& x, const Defect& defect) const {
  if (!(defect.size <= tolerated(defect))) return false;
  const double part = defect.size <= defect.rounding ? std::max(tolerance_, lost) : tolerance_;
  return error().lpNorm<Eigen::Infinity>() <= part * x.lpNorm<Eigen::Infinity>();
}

/// A solution that is good enough stays as it is and leaves no trace, so that a step that is looked at twice, as
/// where a restart file is written, changes no byte of what follows.
bool AmgSolver::is_solved_by_last(const Eigen::VectorXd& b, Eigen::VectorXd& x, Defect& defect) {
  measure(b, x, defect);
  if (defect.size <= tolerated(defect)) {
    set_out(defect.r);
    if (is_solved(x, defect)) return true;
  }
  last_.begin(matrix_, defect.r, x);
  return false;
}

void AmgSolver::iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  iterations_ = 0;
  Defect recurrence, seen;
  if (!x.isZero(0.0) && is_solved_by_last(b, x, recurrence)) return;
  measure(b, x, recurrence);
  set_out(recurrence.r);
  if (is_solved(x, recurrence)) return;
  double end = tolerated(recurrence);
  while (iterations_ < most_cycles && advance(x, recurrence.r)) {
    ++iterations_;
    recurrence.size = recurrence.r.norm();
    if (recurrence.size > end && iterations_ != first_look) continue;
    measure(b, x, seen);
    if (is_solved(x, seen)) return;
    end = tolerated(seen);
    if (seen.size <= drift * recurrence.size) continue;
    std::swap(recurrence, seen);
    set_out(recurrence.r);
  }
  fail_after(iterations_, b, recurrence.r);
}

}  // namespace pfv
