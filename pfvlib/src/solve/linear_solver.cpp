// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/linear_solver.hpp"

#include "pfv/error.hpp"
#include "solve/amesos2_solver.hpp"
#include "solve/iterative_solvers.hpp"

namespace pfv {

Eigen::VectorXd multiply(const SymmetricMatrix& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd product(matrix.size());
  for (int row = 0; row < matrix.size(); ++row) {
    double sum = 0.0;
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      sum += matrix.value[k] * x[matrix.column[k]];
    }
    product[row] = sum;
  }
  return product;
}

std::unique_ptr<LinearSolver> make_solver(const Options& options, std::shared_ptr<Team> team) {
  check(options.solver, options.ordering);
  const SolverKind kind = resolved(options.solver);
  switch (kind) {
    case SolverKind::cg: return std::make_unique<ConjugateGradient>(options.tolerance);
    case SolverKind::gauss_seidel: return std::make_unique<GaussSeidel>(options.tolerance);
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

}  // namespace pfv
