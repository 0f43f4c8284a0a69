// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/checked_solver.hpp"

#include <vector>

namespace pfv {

/// What the iterative solvers share. They start from x = 0, so that one b gives one x, and end
/// where the residual is below `tolerance` of b or is rounding error of A x; SolverError where that
/// is not reached.
class IterativeSolver : public CheckedSolver {
 public:
  IterativeSolver(SolverKind kind, double tolerance)
      : CheckedSolver(kind), tolerance_(tolerance) {}

 protected:
  virtual void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;  ///< from x = 0
  void analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd&) override;
  bool has_pattern_of(const SymmetricMatrix& matrix) const override;
  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  /// r = b - A x; true where it is small enough.
  bool is_solved(const Eigen::VectorXd& b, const Eigen::VectorXd& x, Eigen::VectorXd& r) const;
  /// SolverError unless the diagonal is positive.
  void keep_values(const SymmetricMatrix& matrix);
  [[noreturn]] void fail_at(int row) const;
  [[noreturn]] void fail_after(int iterations, const Eigen::VectorXd& b,
                               const Eigen::VectorXd& r) const;

  double tolerance_;
  SymmetricMatrix matrix_;
  std::vector<int> diagonal_;  ///< where each row's diagonal entry is
};

/// Conjugate gradients, preconditioned by the incomplete Cholesky factor on the matrix' own pattern
/// (Meijerink and van der Vorst 1977: it exists, as no conductance is negative).
class ConjugateGradient final : public IterativeSolver {
 public:
  explicit ConjugateGradient(double tolerance) : IterativeSolver(SolverKind::cg, tolerance) {}

 private:
  void factor_values(const SymmetricMatrix& matrix) override;
  void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

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
