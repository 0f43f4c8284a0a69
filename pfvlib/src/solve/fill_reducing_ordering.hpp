// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/team.hpp"
#include "pfv/options.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// The permutation for a choice of the user: entry k is the row that is eliminated k-th. Empty for amd,
/// which CHOLMOD does itself. `automatic` is geometric where there are coordinates, else metis.
std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates, Team& team);
std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates);

}  // namespace pfv
