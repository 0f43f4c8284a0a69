// SPDX-License-Identifier: GPL-3.0-or-later
// What a host on several ranks asks for beside a flow; needs no mpi.h.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pfv {

class Ranks;

/// The rank that each place (m) belongs to where each is to have about as many as the others, within a box of its own:
/// recursive bisection across the longest edge of what is to be divided. It does not depend on which rank tells of a
/// place. Cost: some 40 sums over all ranks for each halving of their number. Collective.
std::vector<int> parts_by_place(const Eigen::Ref<const Eigen::Matrix3Xd>& places, const Ranks& ranks);

/// Whether all ranks know of the last error that was thrown; else one has failed alone, and the others may wait for it
/// for ever: end them (MPI_Abort).
bool failed_together(const Ranks& ranks);

}  // namespace pfv
