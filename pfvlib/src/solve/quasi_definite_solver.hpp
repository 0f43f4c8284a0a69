// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/checked_solver.hpp"
#include "sparse/cholesky.hpp"

#include <memory>
#include <vector>

namespace pfv {

/// P K P^T = L D L^T, D = 1 or -1, by the supernodal code. K = [-G S^T; S H] with G and H positive definite has one
/// in any order. G may leave some unknowns undetermined that S determines: those come last.
class QuasiDefiniteSolver final : public CheckedSolver {
 public:
  QuasiDefiniteSolver(OrderingKind ordering, std::shared_ptr<Team> team);

  /// For the next `order`: the sign of each unknown's pivot, and the unknowns whose pivots come after all others.
  void describe(std::vector<double> signs, std::vector<int> last);
  std::string name() const override { return "supernodal"; }
  void share_with(std::shared_ptr<Team> team) override { team_ = std::move(team); }

 private:
  void analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) override;
  bool has_pattern_of(const SymmetricMatrix& matrix) const override;
  void factor_values(const SymmetricMatrix& matrix) override;
  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;

  OrderingKind ordering_;
  std::shared_ptr<Team> team_;
  std::vector<double> signs_;
  std::vector<int> last_;
  std::vector<int> row_begin_, column_;  ///< the pattern that was ordered
  SparseCholesky factor_;
};

}  // namespace pfv
