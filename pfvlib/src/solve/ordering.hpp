// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/linear_solver.hpp"

#include <vector>

namespace pfv {

/// Fill-reducing permutation by METIS' multilevel nested dissection: entry k is the row that is
/// eliminated k-th. Depends on the pattern alone, and the same pattern gives the same permutation.
/// Throws SolverError when METIS fails.
std::vector<int> metis_ordering(const SymmetricMatrix& matrix);

}  // namespace pfv
