// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/packing.hpp"

namespace pfv {

/// A dense random packing in the unit cube, for benchmarks and trials: radii spread evenly over 1 +-
/// `spread` times their mean, pushed apart until what overlaps is a per mille of a radius or so. Same
/// arguments, same packing. Ids 1 to `spheres`, no velocities. Throws InputError for what no packing
/// can be made of. Cost: some 30 microseconds a sphere and 10 sweeps.
PackingArrays dense_packing(int spheres, double solid_fraction = 0.6, double spread = 0.2,
                            unsigned seed = 1, int sweeps = 400);

}  // namespace pfv
