// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"
#include "parallel/share.hpp"
#include "network/pore_network.hpp"

#include <memory>

namespace pfv {

/// This rank's part of the network of all grains.
struct SharedNetwork {
  Halo halo;
  ActiveGrains grains;  ///< of `halo.seen()`
  PoreSpace space;
  Share share;
};

/// Each rank triangulates its grains with those of others around them. A cell is that of all grains where the ball
/// that is orthogonal to its spheres, widened by the largest sphere, lies where all grains are known; where it does
/// not, the ranks whose grains it may reach are asked (a certificate; no width of a halo would be safe where there is
/// open space). Kept are the cells around own grains, those around the grains of these, and one layer more: what
/// pressures, conductances, rates and forces of own pores and grains follow from, value for value as on one rank.
/// Throws InputError on all ranks alike. Collective. Cost: a triangulation a round; dense packings need one or two.
SharedNetwork build_shared_network(const Packing& own, const Container& container, OutsideGrains outside,
                                   std::shared_ptr<const Ranks> ranks);

}  // namespace pfv
