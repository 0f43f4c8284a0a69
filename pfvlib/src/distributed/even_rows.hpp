// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/packing.hpp"

namespace pfv {

// Rows of which each rank has some, those of rank 0 first.

/// How many stand before this rank's, and how many there are. Collective.
Eigen::Index rows_before(Eigen::Index own, const Ranks& ranks);
Eigen::Index rows_of_all(Eigen::Index own, const Ranks& ranks);

/// The same spheres in the same order, as many on each rank as on the others or one more. Collective.
PackingArrays evenly_divided(PackingArrays rows, const Ranks& ranks);

}  // namespace pfv
