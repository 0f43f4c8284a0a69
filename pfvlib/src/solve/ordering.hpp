// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/linear_solver.hpp"

#include <vector>

namespace pfv {

/// The permutation for a choice of the user: entry k is the row that is eliminated k-th. Empty for
/// amd, which CHOLMOD does itself. `automatic` is geometric where there are coordinates, else
/// metis.
std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates, Team& team);
std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates);

/// METIS' multilevel nested dissection. Depends on the pattern alone, and the same pattern gives
/// the same permutation. Throws SolverError when METIS fails.
std::vector<int> metis_ordering(const SymmetricMatrix& matrix);

/// Nested dissection in space: a part is cut across its long directions, the separator is
/// refined on the graph, and parts that are small enough are left to minimum degree. Several times
/// cheaper than METIS for some 3 % more fill. `coordinates`: one column an unknown. Throws
/// SolverError without them, or out of memory. `team` shares the dissection; no entry depends on it.
std::vector<int> geometric_ordering(const SymmetricMatrix& matrix,
                                    const Eigen::Matrix3Xd& coordinates, Team& team);
std::vector<int> geometric_ordering(const SymmetricMatrix& matrix,
                                    const Eigen::Matrix3Xd& coordinates);

}  // namespace pfv
