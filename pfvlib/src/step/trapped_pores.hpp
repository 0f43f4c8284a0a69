// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/built_network.hpp"
#include "step/solution.hpp"

#include <vector>

namespace pfv {

/// Marks the set with the most fluid as the fluid itself where no pressure is imposed and nothing is stored.
void mark_main_fluid(BuiltNetwork& built);

/// Of the present network, on all ranks.
std::int64_t trapped_pores(const BuiltNetwork& built);

/// Shifts the relative pressures of each trapped set, which continuity leaves undetermined, to the level of what is
/// around it: over the closed throats (facets' area A) that bound it, the sum of A (p_inside - p_outside) is 0, sets
/// that lie side by side included. `isolated`: those that are held by pins. Cost: throats, where there are any.
/// Collective.
void level_trapped_pores(const BuiltNetwork& built, const std::vector<Isolated>& isolated, Solution& solution);

}  // namespace pfv
