// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/throats.hpp"
#include "pfv/box.hpp"

namespace pfv {

/// Replaces what `measure_throats` found by the rules of YADE's FlowEngine (2023.02a, from its
/// documented behaviour and its output), so that its users can reproduce their results:
/// - the domain of a throat is parted around the dual edge with unsigned solid angles;
/// - a disc takes its full sector of the facet, overlaps or not; one that crosses the opposite side of
///   its triangle gives the segment beyond it back to A^f;
/// - a symmetry wall divides the conductance by sqrt(2) (Throats::conductance_factor).
/// The sums over all throats are then no longer the pore volume and the solid surface.
void apply_yade_partition(Throats& throats, const PoreNetwork& network, const Spheres& spheres,
                          const Container& container);

}  // namespace pfv
