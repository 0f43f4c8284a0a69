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
/// pores of a flux boundary share, on whatever rank they are. Few pores share others (Unknowns::shared): one rank has the
/// row of such a one, and each rank what its pores give of it.
struct RowShare {
  std::shared_ptr<const Ranks> ranks;
  std::vector<char> own;              ///< of each unknown here; a border is nobody's
  std::vector<std::int64_t> number;   ///< in the whole matrix, those of one rank together; -1: a border, or not needed
  std::int64_t first = 0, count = 0;  ///< own numbers are first ... first + count - 1
  std::int64_t total = 0;             ///< of all ranks, without borders
  std::vector<std::int64_t> begins;   ///< of each rank the first of its numbers, and the total
  Exchange exchange;                  ///< of ghosts
  Exchange shared;                    ///< of these the unknowns that pores of several ranks may share
  std::vector<int> borders;           ///< of each border the unknown that stands for it here, or -1

  /// What all know an unknown by: its number, or that of a border behind all others; -1: not needed.
  std::int64_t name_of(int unknown) const;
  int rank_of(std::int64_t number) const;
  /// Adds up, at their owners, what all ranks have of shared unknowns; 0 is left elsewhere. Collective.
  void collect(Eigen::VectorXd& values) const;
};

/// Numbers the unknowns of all ranks. Shared ones lead to others that their owners may not know yet: these are added
/// behind the unknowns. Collective.
std::shared_ptr<const RowShare> share_rows(const PoreNetwork& network, const std::vector<double>& conductances,
                                           Unknowns& unknowns, const Share& share);

/// Adds up, at their owners, what all ranks have of the rows of shared unknowns. Collective.
void collect_rows(SymmetricMatrix& matrix, const RowShare& rows);

/// Sets of unknowns that no open throat joins to an imposed pressure, with the own pores of each in the order in which
/// all ranks have the sets. The unknown that is held is -1 but on one rank. Collective.
std::vector<Isolated> find_isolated(const PoreNetwork& network, const std::vector<double>& conductances,
                                    const Unknowns& unknowns, const Share& share, const RowShare& rows);

/// |b - A x| / |b| over the own rows of all ranks; of b what each has. Collective.
double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& parts,
                         const RowShare& rows);

/// Spreads a value of each row to all rows that it is joined to: the largest of them. `sets`: of rows that are joined
/// here; `values`: one a row. Collective.
void spread_largest(const RowShare& rows, class DisjointSets& sets, Eigen::VectorXd& values);

}  // namespace pfv
