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
  return resolved(solver) == SolverKind::klu2 ? OrderingKind::amd : OrderingKind::geometric;
}

void check(SolverKind solver, OrderingKind ordering) {
  const bool orders_itself = ordering == OrderingKind::automatic || ordering == OrderingKind::amd;
  if (resolved(solver) == SolverKind::klu2 && !orders_itself) {
    throw InputError(std::string("the solver klu2 has an ordering of its own and takes no ") +
                     name_of(ordering) + "; use the ordering amd or auto, or the solver cholmod");
  }
}

std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering) {
  check(solver, ordering);
  return make_amesos2_solver(resolved(solver), ordering);
}

}  // namespace pfv
