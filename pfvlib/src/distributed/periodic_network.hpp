// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/shared_network.hpp"

namespace pfv {

/// `build_shared_network` of a packing that repeats: each rank triangulates, in the coordinates of the cell, the images of
/// its grains in and around it with all images around these. Pores of one rank are then numbered, placed and cut as on
/// one rank: they lie in the cell, and have images of spheres beyond it. What is kept follows from the cells around own
/// grains where these are, as without periodic axes; of each of them the image in the cell is taken. Where that is not
/// there, the margin grows.
SharedNetwork build_periodic_network(const Packing& own, const Container& container, OutsideGrains outside,
                                     std::shared_ptr<const Ranks> ranks);

}  // namespace pfv
