// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/iterative_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pfv {
namespace {

constexpr int most_iterations = 20000;
constexpr int most_sweeps = 200000;
constexpr int sweeps_between_checks = 10;
/// Measured at 2000 and 16000 spheres: a quarter of the sweeps of 1.8.
constexpr double relaxation = 1.95;

}  // namespace

void IterativeSolver::analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd&) {
  matrix_ = matrix;
  diagonal_.resize(matrix.size());
  for (int row = 0; row < matrix.size(); ++row) {
    int k = matrix.row_begin[row];
    while (matrix.column[k] != row) ++k;
    diagonal_[row] = k;
  }
}

bool IterativeSolver::has_pattern_of(const SymmetricMatrix& matrix) const {
  return matrix.row_begin == matrix_.row_begin && matrix.column == matrix_.column;
}

void IterativeSolver::keep_values(const SymmetricMatrix& matrix) {
  matrix_.value = matrix.value;
  for (int row = 0; row < size(); ++row) {
    if (!(matrix.value[diagonal_[row]] > 0.0)) fail_at(row);
  }
}

void IterativeSolver::solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  together([&] {
    if (!b.allFinite())
      fail("the right-hand side is not finite; look at the boundary pressures, fluxes and velocities");
  });
  if (largest(b) == 0.0) {
    x.setZero();
    return;
  }
  begin(b, x);
  iterate(b, x);
}

void IterativeSolver::begin(const Eigen::VectorXd&, Eigen::VectorXd& x) { x.setZero(); }

void IterativeSolver::fail_at(int row) const {
  fail("the matrix is not positive definite at row " + std::to_string(row) +
       ": nothing determines the pressure of a group of pores, or a conductance is negative; "
       "impose a pressure on a face or patch that the group reaches");
}

void IterativeSolver::fail_after(int iterations, const Eigen::VectorXd& b,
                                 const Eigen::VectorXd& r) const {
  std::ostringstream text;
  text << "no solution after " << iterations << " iterations (the residual is "
       << norm(r) / norm(b) << " of the right-hand side); "
       << (ranks() ? "look for spheres that nearly coincide, or run on one rank with the solver supernodal"
                   : "use the solver supernodal");
  together([&] { fail(text.str()); });
  fail(text.str());
}

bool IterativeSolver::is_solved(const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                                Eigen::VectorXd& r) const {
  r.resize(size());
  double rounding = 0.0;  // squared norm of |A| |x|
  for (int row = 0; row < size(); ++row) {
    double sum = b[row], magnitude = 0.0;
    for (int k = matrix_.row_begin[row]; k < matrix_.row_begin[row + 1]; ++k) {
      const double term = matrix_.value[k] * x[matrix_.column[k]];
      sum -= term;
      magnitude += std::abs(term);
    }
    r[row] = sum;
    rounding += magnitude * magnitude;
  }
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return r.norm() <= std::max(tolerance_ * b.norm(), epsilon * std::sqrt(rounding));
}

void ConjugateGradient::set_out(const Eigen::VectorXd& r) {
  z_.resize(r.size());
  precondition(r, z_);
  direction_ = z_;
  rz_ = dot(r, z_);
}

bool ConjugateGradient::advance(Eigen::VectorXd& x, Eigen::VectorXd& r) {
  product_ = multiply(matrix_, direction_);
  const double step = rz_ / dot(direction_, product_);
  if (!(step > 0.0)) return false;
  x += step * direction_;
  r -= step * product_;
  precondition(r, z_);
  const double next = dot(r, z_);
  direction_ = z_ + next / rz_ * direction_;
  rz_ = next;
  return true;
}

// Row i of L: L_ij = A_ij - sum_k<j L_ik L_jk / D_k, D_i = L_ii, where A has an entry.
void IncompleteCholesky::factor_values(const SymmetricMatrix& matrix) {
  keep_values(matrix);
  factor_ = matrix.value;
  inverse_pivot_.resize(size());
  const auto& [row_begin, column, value] = matrix_;
  for (int i = 0; i < size(); ++i) {
    for (int p = row_begin[i]; p <= diagonal_[i]; ++p) {
      const int j = column[p];
      for (int a = row_begin[i], b = row_begin[j]; a < p && b < diagonal_[j];) {
        if (column[a] == column[b]) {
          factor_[p] -= factor_[a] * factor_[b] * inverse_pivot_[column[a]];
          ++a;
          ++b;
        } else if (column[a] < column[b]) {
          ++a;
        } else {
          ++b;
        }
      }
    }
    if (!(factor_[diagonal_[i]] > 1e-14 * value[diagonal_[i]])) fail_at(i);
    inverse_pivot_[i] = 1.0 / factor_[diagonal_[i]];
  }
}

/// z = (L D^-1 L^T)^-1 r.
void IncompleteCholesky::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  for (int i = 0; i < size(); ++i) {
    double sum = r[i];
    for (int k = matrix_.row_begin[i]; k < diagonal_[i]; ++k) {
      sum -= factor_[k] * z[matrix_.column[k]];
    }
    z[i] = sum * inverse_pivot_[i];
  }
  for (int i = size() - 1; i >= 0; --i) {
    const double here = z[i];
    for (int k = matrix_.row_begin[i]; k < diagonal_[i]; ++k) {
      const int j = matrix_.column[k];
      z[j] -= factor_[k] * here * inverse_pivot_[j];
    }
  }
}

// The recurrence of r drifts away from b - A x: where it says that it is done, begin again from x.
void IncompleteCholesky::iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  Eigen::VectorXd r;
  int iterations = 0;
  while (!is_solved(b, x, r)) {
    if (iterations >= most_iterations || !r.allFinite()) fail_after(iterations, b, r);
    set_out(r);
    const double aim = std::max(1e-2 * tolerance_ * b.norm(), 1e-3 * r.norm());
    for (; iterations < most_iterations && r.norm() > aim; ++iterations)
      if (!advance(x, r)) fail_after(iterations, b, r);
  }
}

void GaussSeidel::iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  Eigen::VectorXd r;
  for (int sweep = 0; !is_solved(b, x, r); sweep += sweeps_between_checks) {
    if (sweep >= most_sweeps || !r.allFinite()) fail_after(sweep, b, r);
    for (int k = 0; k < sweeps_between_checks; ++k) {
      for (int row = 0; row < size(); ++row) {
        double sum = b[row];
        for (int entry = matrix_.row_begin[row]; entry < matrix_.row_begin[row + 1]; ++entry) {
          sum -= matrix_.value[entry] * x[matrix_.column[entry]];
        }
        x[row] += relaxation * sum / matrix_.value[diagonal_[row]];
      }
    }
  }
}

}  // namespace pfv
