// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/linear_solver.hpp"

#include "pfv/error.hpp"
#include "solve/amesos2_solver.hpp"

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
  return resolved(solver) == SolverKind::klu2 ? OrderingKind::amd : OrderingKind::metis;
}

std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering) {
  if (solver == SolverKind::klu2 && ordering == OrderingKind::metis) {
    throw InputError("the solver klu2 has an ordering of its own and takes no metis; use the "
                     "ordering amd or auto, or the solver cholmod");
  }
  return make_amesos2_solver(resolved(solver), resolved(solver, ordering));
}

}  // namespace pfv
