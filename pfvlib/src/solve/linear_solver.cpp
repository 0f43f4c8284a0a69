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

SolverKind resolved(SolverKind solver) {
  return solver == SolverKind::automatic ? SolverKind::cholmod : solver;
}

OrderingKind resolved(SolverKind solver, OrderingKind ordering) {
  if (ordering != OrderingKind::automatic) return ordering;
  if (resolved(solver) == SolverKind::cholmod) return OrderingKind::geometric;
  return resolved(solver) == SolverKind::klu2 ? OrderingKind::amd : OrderingKind::automatic;
}

void check(SolverKind solver, OrderingKind ordering) {
  const SolverKind kind = resolved(solver);
#ifndef PFV_WITH_MUMPS
  if (kind == SolverKind::mumps) {
    throw InputError("this build has no solver mumps; configure it with -DPFV_WITH_MUMPS=ON, or "
                     "use the solver cholmod");
  }
#endif
  if (kind == SolverKind::cholmod || ordering == OrderingKind::automatic) return;
  if (kind == SolverKind::klu2 && ordering == OrderingKind::amd) return;
  throw InputError(std::string("the solver ") + name_of(kind) + " takes no ordering " +
                   name_of(ordering) + "; use " +
                   (kind == SolverKind::klu2 ? "the ordering amd (its own) or auto" :
                                               "the ordering auto") +
                   ", or the solver cholmod");
}

bool is_iterative(SolverKind solver) {
  return solver == SolverKind::cg || solver == SolverKind::gauss_seidel;
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
