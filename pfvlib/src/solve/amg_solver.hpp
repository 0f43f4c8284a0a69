// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/algebraic_multigrid.hpp"
#include "solve/borders.hpp"
#include "solve/iterative_solvers.hpp"
#include "solve/last_solutions.hpp"

namespace pfv {

/// Conjugate gradients with hypre's BoomerAMG, whose hierarchy serves all right-hand sides of a matrix of
/// conductances (no positive entry beside the diagonal). Ends where the mass defect of the pores is below
/// `tolerance` of the flow through them (2-norms) and the error of the pressures, as a V-cycle sees it, below
/// `tolerance` of the largest, or where both are rounding. An x that is not 0 is the last solution of a sequence:
/// the solve sets out from it and the changes before; the bytes of x are then those of the sequence.
/// On several ranks each has its own rows, and the sums of the iterations go over all.
class AmgSolver final : public ConjugateGradient {
 public:
  /// `changes_kept`: doc/solvers.md has how many pay.
  explicit AmgSolver(double tolerance, std::size_t changes_kept = 6)
      : ConjugateGradient(SolverKind::amg, tolerance), last_(changes_kept) {}
  int iterations() const override { return iterations_; }
  void share_rows(std::shared_ptr<const RowShare> rows) override { rows_ = std::move(rows); }

 private:
  /// What x leaves of A x = b.
  struct Defect {
    Eigen::VectorXd r;  ///< b - A x: what of each pore's mass is lost
    double size = 0.0;  ///< 2-norm of r
    double flow = 0.0;  ///< that of the flow through each pore: half of what its throats and sources carry
    double rounding = 0.0;  ///< of r, from the last digits of x
  };

  void analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) override;
  void factor_values(const SymmetricMatrix& matrix) override;
  void begin(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  void iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override;
  const Ranks* ranks() const override { return rows_ ? rows_->ranks.get() : nullptr; }
  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  void take_own_rows(const SymmetricMatrix& matrix);
  void solve_for_borders();
  void refuse_lost_pressures();
  double tolerated(const Defect& defect) const;
  void measure(const Eigen::VectorXd& b, const Eigen::VectorXd& x, Defect& defect) const;
  bool is_solved_by_last(const Eigen::VectorXd& b, Eigen::VectorXd& x, Defect& defect);
  bool is_solved(const Eigen::VectorXd& x, const Defect& defect) const;

  AlgebraicMultigrid multigrid_;
  LastSolutions last_;
  std::shared_ptr<const RowShare> rows_;  ///< null on one rank
  Borders borders_;
  Eigen::VectorXd held_;  ///< of each row: its conductance to imposed pressures, its storage, its pin
  int iterations_ = 0;
};

}  // namespace pfv
