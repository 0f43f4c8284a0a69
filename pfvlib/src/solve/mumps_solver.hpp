// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/checked_solver.hpp"
#include "solve/mumps_factor.hpp"
#include "solve/row_share.hpp"

#include <optional>
#include <vector>

namespace pfv {

/// A direct solver that several ranks may share: each tells MUMPS of its own rows and has a part of the factor. Right-hand
/// sides and solutions pass through the first rank.
class MumpsSolver final : public CheckedSolver {
 public:
  MumpsSolver() : CheckedSolver(SolverKind::mumps) {}
  void share_rows(std::shared_ptr<const RowShare> rows) override { rows_ = std::move(rows); }

 private:
  const Ranks* ranks() const override { return rows_ ? rows_->ranks.get() : nullptr; }
  void analyze_pattern(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) override;
  bool has_pattern_of(const SymmetricMatrix& matrix) const override;
  void factor_values(const SymmetricMatrix& matrix) override;
  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override;

  bool is_own(int row) const { return !rows_ || rows_->own[row]; }
  void find_names();
  void find_told(const SymmetricMatrix& matrix);
  Eigen::VectorXd row_sums(const SymmetricMatrix& matrix) const;
  void refuse_lost_pressures(const SymmetricMatrix& matrix);
  std::vector<double> gathered(Eigen::VectorXd b) const;
  void hand_out(const std::vector<double>& all, Eigen::VectorXd& x) const;

  std::shared_ptr<const RowShare> rows_;  ///< null on one rank
  SymmetricMatrix pattern_;               ///< without values
  std::vector<int> name_;                 ///< of each row here, in the whole matrix; -1: not needed
  std::vector<char> is_border_;           ///< of each row here
  std::vector<int> told_;                 ///< entries of the matrix here that this rank tells of
  HalfEntries half_;                      ///< these
  std::optional<MumpsFactor> factor_;
};

}  // namespace pfv
