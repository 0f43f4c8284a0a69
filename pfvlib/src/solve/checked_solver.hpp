// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "solve/linear_solver.hpp"

#include <exception>
#include <functional>
#include <new>

namespace pfv {

/// What all solvers ask of their callers and promise them: LinearSolver's call order and refusals.
/// A solver fills in the phases, which are called in order, with at least one unknown, finite
/// values and the pattern that was ordered.
class CheckedSolver : public LinearSolver {
 public:
  explicit CheckedSolver(SolverKind solver) : solver_(solver) {}

  std::string name() const override { return name_of(solver_); }
  void order(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) final;
  void factor(const SymmetricMatrix& matrix) final;
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) final;

 protected:
  virtual void analyze_pattern(const SymmetricMatrix& matrix,
                               const Eigen::Matrix3Xd& coordinates) = 0;
  virtual bool has_pattern_of(const SymmetricMatrix& matrix) const = 0;
  virtual void factor_values(const SymmetricMatrix& matrix) = 0;
  virtual void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;

  SolverKind kind() const { return solver_; }
  int size() const { return size_; }
  /// Those that share the rows; null on one rank. Where there are others, this one may have no rows.
  virtual const Ranks* ranks() const { return nullptr; }
  /// What may throw on one of them, so that all do.
  void together(const std::function<void()>& check) const;
  /// SolverError with the solver's name in front.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void require(bool condition, const char* message) const;
  void require_finite_values(const SymmetricMatrix& matrix) const;
  bool is_idle() const { return size_ == 0 && !ranks(); }
  template <class Phase>
  void guarded(const char* phase_name, const Phase& phase) const;

  SolverKind solver_;
  int size_ = 0;
  bool is_ordered_ = false;
  bool is_factored_ = false;
};

}  // namespace pfv
