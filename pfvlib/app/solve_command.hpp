// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "solve_arguments.hpp"

#include <iosfwd>
#include <memory>

namespace pfv::app {

/// Solves the flow through one packing and writes what was asked for. A summary goes to `out`,
/// warnings of one line each go to `warnings`. `ranks`: those that share the work, each with these streams; null: one.
void solve(const SolveRequest& request, const std::shared_ptr<const Ranks>& ranks, std::ostream& out,
           std::ostream& warnings);

}  // namespace pfv::app
