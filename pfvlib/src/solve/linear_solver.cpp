// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/linear_solver.hpp"

#include "solve/amesos2_solver.hpp"
#include "solve/amg_solver.hpp"
#include "solve/iterative_solvers.hpp"
#include "problem/solver_abilities.hpp"

namespace pfv {

std::unique_ptr<LinearSolver> make_solver(const Options& options, std::shared_ptr<Team> team) {
  check(options);
  const SolverKind kind = resolved(options.solver);
  const double tolerance = options.tolerance.value_or(abilities_of(kind).tolerance);
  switch (kind) {
    case SolverKind::amg: return std::make_unique<AmgSolver>(tolerance);
    case SolverKind::cg: return std::make_unique<IncompleteCholesky>(tolerance);
    case SolverKind::gauss_seidel: return std::make_unique<GaussSeidel>(tolerance);
    default:
      if (!team) team = std::make_shared<Team>();
      return make_amesos2_solver(kind, options.ordering, options.precision, std::move(team));
  }
}

std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering) {
  Options options;
  options.solver = solver;
  options.ordering = ordering;
  return make_solver(options);
}

double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b) {
  const double scale = b.norm();
  if (b.size() == 0 || scale == 0.0) return 0.0;
  return (b - multiply(matrix, x)).norm() / scale;
}

}  // namespace pfv
