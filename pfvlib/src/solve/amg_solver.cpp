// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/amg_solver.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
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
  if (rows_) take_own_rows(matrix);
  else keep_values(matrix);
  held_ = row_sums(matrix_);
  refuse_lost_pressures();
  last_.forget(ranks());
  std::string problem;
  try {
    multigrid_.build(matrix_, rows_.get());
  } catch (const std::exception& error) {
    problem = error.what();
  }
  together([&] {
    if (!problem.empty()) throw std::runtime_error(problem);
  });
  if (rows_) solve_for_borders();
}

/// The rows of others stay, empty, so that an entry of x has one place.
void AmgSolver::take_own_rows(const SymmetricMatrix& matrix) {
  borders_.take(matrix, *rows_);
  matrix_.value = matrix.value;
  std::vector<char> is_border(static_cast<std::size_t>(size()), 0);
  for (const int border : rows_->borders)
    if (border >= 0) is_border[border] = 1;
  together([&] {
    for (int row = 0; row < size(); ++row) {
      for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1] && rows_->own[row]; ++k)
        if (rows_->number[matrix.column[k]] < 0 && !is_border[matrix.column[k]])
          fail("a pore of this rank leads to one whose owner is not known: please report this; a run on one rank avoids it");
      if (!rows_->own[row])
        std::fill(matrix_.value.begin() + matrix_.row_begin[row], matrix_.value.begin() + matrix_.row_begin[row + 1], 0.0);
      else if (!(matrix.value[diagonal_[row]] > 0.0))
        fail_at(row);
    }
  });
}

void AmgSolver::solve_for_borders() {
  constexpr double beyond = 0.1;  // what is left of these solutions is left of each that follows
  if (borders_.count() == 0) return;
  const double tolerance = tolerance_;
  tolerance_ *= beyond;
  std::vector<Eigen::VectorXd> solutions(borders_.count(), Eigen::VectorXd::Zero(size()));
  for (int s = 0; s < borders_.count(); ++s)
    if (largest(borders_.column(s)) > 0.0) iterate(borders_.column(s), solutions[s]);
  tolerance_ = tolerance;
  const bool determined = borders_.take_solutions(std::move(solutions), *rows_);
  together([&] {
    if (!determined) fail("nothing determines the pressure of a flux boundary: impose a pressure that its pores reach");
  });
  last_.forget(ranks());
}

/// Conjugate gradients would end at any pressure of a group of pores that nothing holds. A throat that is rounding
/// beside what either of its pores conducts holds none.
void AmgSolver::refuse_lost_pressures() {
  DisjointSets groups(size());
  Eigen::VectorXd is_held = Eigen::VectorXd::Zero(size());
  for (int row = 0; row < size(); ++row)
    for (int k = matrix_.row_begin[row]; k < matrix_.row_begin[row + 1]; ++k) {
      if (!(std::abs(matrix_.value[k]) > 4.0 * epsilon * matrix_.value[diagonal_[row]])) continue;
      // a border is taken out of the matrix, and holds what it is joined to
      if (rows_ && rows_->number[matrix_.column[k]] < 0) is_held[row] = 1.0;
      else groups.join(row, matrix_.column[k]);
    }
  for (int row = 0; row < size(); ++row)
    if (held_[row] != 0.0 || is_held[row] != 0.0) is_held[groups.find(row)] = 1.0;
  if (rows_) spread_largest(*rows_, groups, is_held);
  together([&] {
    for (int row = 0; row < size(); ++row)
      if (is_held[groups.find(row)] == 0.0 && (!rows_ || rows_->own[row])) fail_at(row);
  });
}

void AmgSolver::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  multigrid_.apply(r, z);
  if (rows_) rows_->exchange.refresh(*rows_->ranks, z);
}

void AmgSolver::solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (!rows_) {
    ConjugateGradient::solve_system(b, x);
    return;
  }
  Eigen::VectorXd own = b;
  rows_->collect(own);
  const Eigen::VectorXd at_borders = borders_.take_out(own, *rows_);
  for (int row = 0; row < size(); ++row)
    if (!rows_->own[row]) own[row] = 0.0;
  borders_.begin(x, *rows_);
  ConjugateGradient::solve_system(own, x);
  borders_.put_in(at_borders, x, *rows_);
}

void AmgSolver::begin(const Eigen::VectorXd&, Eigen::VectorXd& x) {
  const bool lost = !x.allFinite();
  if (rows_ ? rows_->ranks->any(lost) : lost) x.setZero();
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
  if (rows_) {
    double sums[2] = {flow, magnitude};
    rows_->ranks->add(sums, 2);
    flow = sums[0];
    magnitude = sums[1];
  }
  defect.size = norm(defect.r);
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
  return largest(error()) <= part * largest(x);
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
  if (largest(x) != 0.0 && is_solved_by_last(b, x, recurrence)) return;
  measure(b, x, recurrence);
  set_out(recurrence.r);
  if (is_solved(x, recurrence)) return;
  double end = tolerated(recurrence);
  while (iterations_ < most_cycles && advance(x, recurrence.r)) {
    ++iterations_;
    recurrence.size = norm(recurrence.r);
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
