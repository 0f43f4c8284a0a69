// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"
#include "parallel/share.hpp"
#include "network/pore_network.hpp"

#include <vector>

namespace pfv {

/// A pore belongs to the owner of the sphere of lowest id of its first cell. Fills in whose the pores are and who tells
/// whom of what. `whole`: pores that have all their throats. Throws SolverError where the ranks have not
/// found the same pores. Collective.
void find_owners(const PoreSpace& space, const ActiveGrains& grains, const Halo& halo, const std::vector<char>& whole,
                 Share& share);

}  // namespace pfv
