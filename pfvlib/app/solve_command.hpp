// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve_arguments.hpp"

#include <iosfwd>

namespace pfv::app {

/// Solves the flow through one packing and writes what was asked for. A summary goes to `out`,
/// warnings of one line each go to `warnings`.
void solve(const SolveRequest& request, std::ostream& out, std::ostream& warnings);

}  // namespace pfv::app
