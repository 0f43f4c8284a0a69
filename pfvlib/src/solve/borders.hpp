// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/row_share.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

namespace pfv {

/// The pressures that the pores of a flux boundary share, over several ranks. A dense row would join all of them; so
/// they are taken out of the matrix: with c the column of a border and A that of all others, A y = b and A z = c give
/// x = y - z p, where p follows from the border's own row. z is found once for a matrix.
class Borders {
 public:
  /// `matrix`: rows as assembled, those of borders in parts. Collective.
  void take(const SymmetricMatrix& matrix, const RowShare& rows);
  int count() const { return static_cast<int>(columns_.size()); }
  /// c of each, in own rows.
  const Eigen::VectorXd& column(int border) const { return columns_[border]; }
  /// Takes z of each; false where nothing determines the pressure of one. Collective.
  bool take_solutions(std::vector<Eigen::VectorXd> solutions, const RowShare& rows);
  /// What b has for each border; these entries become 0. Collective.
  Eigen::VectorXd take_out(Eigen::VectorXd& b, const RowShare& rows) const;
  /// Makes the x of a former solve the y that it was made from.
  void begin(Eigen::VectorXd& x, const RowShare& rows) const;
  /// Makes y the x of all. Collective.
  void put_in(const Eigen::VectorXd& right_side, Eigen::VectorXd& x, const RowShare& rows) const;

 private:
  /// c_k^T v of each, over all ranks.
  Eigen::VectorXd products(const Eigen::VectorXd& v, const RowShare& rows) const;

  std::vector<Eigen::VectorXd> columns_, solutions_;
  Eigen::MatrixXd among_;  ///< the borders' rows in their own columns
  Eigen::FullPivLU<Eigen::MatrixXd> factor_;
};

}  // namespace pfv
