// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/team.hpp"
#include "pfv/options.hpp"
#include "problem/solver_abilities.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>

namespace pfv {

struct RowShare;

/// One solver. Call order: order, factor (again after new values on the same pattern),
/// solve as often as there are right-hand sides. No unknowns are fine: nothing is done.
/// Same matrix and b, same bytes. Prints nothing. Every method throws SolverError, one line with
/// the solver's name: a call out of order, a matrix that is singular, not positive definite
/// or not finite, a solution that is not finite, no memory.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Fill-reducing ordering and symbolic factorisation of the pattern. `coordinates`: the place of
  /// each unknown, one column each, or empty where nothing geometric is wanted.
  virtual void order(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates = {}) = 0;
  /// Numeric factorisation; `matrix` has the pattern given to `order`, else SolverError.
  virtual void factor(const SymmetricMatrix& matrix) = 0;
  /// x = A^-1 b. An x of length n is where mixed precision and amg set out from, the last solution of a sequence or
  /// zeros. With zeros one b gives one x.
  virtual void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;
  virtual std::string name() const = 0;
  /// Of the last solve, where the solver counts them; else 0.
  virtual int iterations() const { return 0; }
  /// The team that shares the work from now on. No byte depends on it.
  virtual void share_with(std::shared_ptr<Team> team) { (void)team; }
  /// Before `order`: the rows of several ranks (solve/row_share.hpp). Matrix, b and x have own rows, ghosts and borders;
  /// b counts in own rows and, summed over the ranks, in borders; x comes back in all. From then on every call is
  /// collective. InputError where the solver has no such form.
  virtual void share_rows(std::shared_ptr<const RowShare> rows);
};

/// The solver that the options name (automatic choices are resolved), with its ordering, precision and
/// tolerance. Throws InputError for a combination that makes no sense. `team` shares the work of
/// supernodal; null: the caller's thread does them.
std::unique_ptr<LinearSolver> make_solver(const Options& options,
                                          std::shared_ptr<Team> team = nullptr);
/// The same with the other options as they are by default.
std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering);

/// |b - A x| / |b|; 0 where there is nothing to solve.
double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b);

}  // namespace pfv
