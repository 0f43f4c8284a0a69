// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/problem.hpp"
#include "step/solution.hpp"

#include <vector>

namespace pfv {

/// Throws InputError for boundaries and motions that leave the pressure undetermined.
void refuse_undetermined(const Problem& problem, bool moving);

/// A set of pores without any way to a pressure can only be at rest: throws InputError where it is not.
void refuse_isolated(const BuiltNetwork& built, const Solution& solution,
                     const std::vector<Isolated>& held);

/// Throws InputError where the pores at a round wall do not close: what the cells beside it are swept from then
/// reaches around the axis. Does nothing for plane walls. Cost: a pass over the facets.
void refuse_open_pores(const BuiltNetwork& built);

}  // namespace pfv
