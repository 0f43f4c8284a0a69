// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/options.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace pfv {

/// Symmetric positive definite matrix in compressed rows: both triangles, columns sorted in each row.
struct SymmetricMatrix {
  std::vector<int> row_begin{0};  ///< n + 1
  std::vector<int> column;
  std::vector<double> value;

  int size() const { return static_cast<int>(row_begin.size()) - 1; }
};

/// r = A x.
Eigen::VectorXd multiply(const SymmetricMatrix& matrix, const Eigen::VectorXd& x);

/// One direct solver. Call order: order, factor (again after new values on the same pattern), solve.
/// Every method throws SolverError with the solver's name and its own code or words.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Fill-reducing ordering and symbolic factorisation of the pattern.
  virtual void order(const SymmetricMatrix& matrix) = 0;
  /// Numeric factorisation; `matrix` has the pattern given to `order`.
  virtual void factor(const SymmetricMatrix& matrix) = 0;
  /// x = A^-1 b; both of length n.
  virtual void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;
  virtual std::string name() const = 0;
};

/// The solver for a choice of the user (automatic choices are resolved). Throws InputError for a
/// combination that makes no sense.
std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering);

/// What `automatic` stands for.
SolverKind resolved(SolverKind solver);
OrderingKind resolved(SolverKind solver, OrderingKind ordering);

}  // namespace pfv
