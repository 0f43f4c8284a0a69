// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/carried_pressures.hpp"

#include <cstddef>
#include <vector>

namespace pfv {

// Pressures of a compressible fluid in a network that several ranks share, from one network to the next and in
// restarts.

/// `carried_pressures` on several ranks. Each cell of the old network is told to one rank, which all ask that have a cell
/// of its name; of the few pores none of whose cells was there before, those that lie in no old cell of their own rank
/// are told to all. Cost: two messages from each rank to each, in all some 150 B a cell. Collective.
Eigen::VectorXd carried_on_ranks(const FormerPressures& old, const BuiltNetwork& now);

/// On the first rank: of each pore, rank after rank in their own order, its number where one rank has them all. No
/// entries on other ranks. Collective.
std::vector<std::size_t> numbers_among_all(const BuiltNetwork& built);

/// Values of all pores in that order; on the first rank, no entries on others. Collective.
std::vector<double> pressures_of_all(const BuiltNetwork& built, const Eigen::VectorXd& values);

/// The reverse: values of this rank's pores, ghosts among them. `numbers`: of `numbers_among_all`. Collective.
Eigen::VectorXd pressures_from_all(const BuiltNetwork& built, const std::vector<std::size_t>& numbers,
                                   const std::vector<double>& all);

}  // namespace pfv
