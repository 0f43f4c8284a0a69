// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/exchange.hpp"
#include "parallel/share.hpp"
#include "solve/pressure_system.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace pfv {

/// What one of several ranks has of the unknowns: its own, ghosts around them, and the *borders*, pressures that all
/// pores of a flux boundary share, on whatever rank they are.
struct RowShare {
  std::shared_ptr<const Ranks> ranks;
  std::vector<char> own;              ///< of each unknown here; a border is nobody's
  std::vector<std::int64_t> number;   ///< in the whole matrix, those of one rank together; -1: a border, or not needed
  std::int64_t first = 0, count = 0;  ///< own numbers are first ... first + count - 1
  std::int64_t total = 0;             ///< of all ranks, without borders
  Exchange exchange;                  ///< of ghosts
  std::vector<int> borders;           ///< of each border the unknown that stands for it here, or -1
};

/// Numbers the unknowns of all ranks. Collective.
std::shared_ptr<const RowShare> share_rows(const Unknowns& unknowns, const Share& share);

/// Sets of unknowns that no open throat joins to an imposed pressure, with the own pores of each in the order in which
/// all ranks have the sets. The unknown that is held is -1 but on one rank. Collective.
std::vector<Isolated> find_isolated(const PoreNetwork& network, const std::vector<double>& conductances,
                                    const Unknowns& unknowns, const Share& share, const RowShare& rows);

/// |b - A x| / |b| over the own rows of all ranks. Collective.
double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& b,
                         const RowShare& rows);

/// Spreads a value of each row to all rows that it is joined to: the largest of them. `sets`: of rows that are joined
/// here; `values`: one a row. Collective.
void spread_largest(const RowShare& rows, class DisjointSets& sets, Eigen::VectorXd& values);

}  // namespace pfv
