// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/quasi_definite_solver.hpp"

#include "solve/fill_reducing_ordering.hpp"

#include <algorithm>
#include <utility>

namespace pfv {

QuasiDefiniteSolver::QuasiDefiniteSolver(OrderingKind ordering, std::shared_ptr<Team> team)
    : CheckedSolver(SolverKind::supernodal), ordering_(ordering), team_(std::move(team)) {}

void QuasiDefiniteSolver::describe(std::vector<double> signs, std::vector<int> last) {
  signs_ = std::move(signs);
  last_ = std::move(last);
}

void QuasiDefiniteSolver::analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) {
  // where some come last, minimum degree would have to know it
  const OrderingKind kind =
      ordering_ == OrderingKind::amd && !last_.empty() ? OrderingKind::geometric : ordering_;
  std::vector<int> permutation = fill_reducing_ordering(kind, matrix, coordinates, *team_);
  std::vector<char> is_last(matrix.size(), 0);
  for (const int k : last_) is_last[k] = 1;
  std::stable_partition(permutation.begin(), permutation.end(), [&](int k) { return !is_last[k]; });
  factor_.analyze(matrix.rows(), permutation);
  row_begin_ = matrix.row_begin;
  column_ = matrix.column;
}

bool QuasiDefiniteSolver::has_pattern_of(const SymmetricMatrix& matrix) const {
  return matrix.row_begin == row_begin_ && matrix.column == column_;
}

void QuasiDefiniteSolver::factor_values(const SymmetricMatrix& matrix) {
  factor_.factorize(matrix.rows(), *team_, signs_);
}

void QuasiDefiniteSolver::solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  factor_.solve(b.data(), x.data(), *team_);
}

}  // namespace pfv
