// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/checked_solver.hpp"

#include <cmath>
#include <vector>

namespace pfv {

/// What the iterative solvers share. SolverError where they do not reach their tolerance.
class IterativeSolver : public CheckedSolver {
 public:
  IterativeSolver(SolverKind kind, double tolerance)
      : CheckedSolver(kind), tolerance_(tolerance) {}

 protected:
  /// The starting vector, in place of the x of the caller: 0, so that one b gives one x.
  virtual void begin(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  virtual void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;  ///< from x on
  void analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd&) override;
  bool has_pattern_of(const SymmetricMatrix& matrix) const override;
  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  /// r = b - A x; true where it is below the tolerance of b or is rounding error of A x.
  bool is_solved(const Eigen::VectorXd& b, const Eigen::VectorXd& x, Eigen::VectorXd& r) const;
  /// Over all ranks. Entries of r and of products are 0 but in own rows.
  double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return ranks() ? ranks()->sum(a.dot(b)) : a.dot(b);
  }
  double norm(const Eigen::VectorXd& r) const { return ranks() ? std::sqrt(dot(r, r)) : r.norm(); }
  double largest(const Eigen::VectorXd& x) const {
    const double here = x.size() > 0 ? x.lpNorm<Eigen::Infinity>() : 0.0;
    return ranks() ? ranks()->largest(here) : here;
  }
  /// SolverError unless the diagonal is positive.
  void keep_values(const SymmetricMatrix& matrix);
  [[noreturn]] void fail_at(int row) const;
  [[noreturn]] void fail_after(int iterations, const Eigen::VectorXd& b,
                               const Eigen::VectorXd& r) const;

  double tolerance_;
  SymmetricMatrix matrix_;
  std::vector<int> diagonal_;  ///< where each row's diagonal entry is
};

/// Preconditioned conjugate gradients (Hestenes and Stiefel 1952).
class ConjugateGradient : public IterativeSolver {
 protected:
  using IterativeSolver::IterativeSolver;
  /// z = M^-1 r, M symmetric and positive definite; where ranks share the rows, with ghosts.
  virtual void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const = 0;
  /// Takes up the direction of steepest descent.
  void set_out(const Eigen::VectorXd& r);
  /// One iteration; false where A or M is not positive definite.
  bool advance(Eigen::VectorXd& x, Eigen::VectorXd& r);
  /// M^-1 r of the last r: about the error of x.
  const Eigen::VectorXd& error() const { return z_; }

 private:
  Eigen::VectorXd z_, direction_, product_;
  double rz_ = 0.0;
};

/// With the incomplete Cholesky factor on the matrix' own pattern (Meijerink and van der Vorst 1977: it exists, as
/// no conductance is negative).
class IncompleteCholesky final : public ConjugateGradient {
 public:
  explicit IncompleteCholesky(double tolerance) : ConjugateGradient(SolverKind::cg, tolerance) {}

 private:
  void factor_values(const SymmetricMatrix& matrix) override;
  void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override;

  std::vector<double> factor_;         ///< on the pattern: the lower triangle of L D L^T
  std::vector<double> inverse_pivot_;  ///< 1 / D
};

/// Gauss-Seidel sweeps with over-relaxation: the method of the field's first codes (Chareyre et al.
/// 2012), for comparison.
class GaussSeidel final : public IterativeSolver {
 public:
  explicit GaussSeidel(double tolerance)
      : IterativeSolver(SolverKind::gauss_seidel, tolerance) {}

 private:
  void factor_values(const SymmetricMatrix& matrix) override { keep_values(matrix); }
  void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
};

}  // namespace pfv
