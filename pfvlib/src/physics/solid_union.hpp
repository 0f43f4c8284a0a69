// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

struct SolidUnion {
  double volume = 0.0;  ///< of the union of the spheres inside the box, m³
  double area = 0.0;    ///< of its surface inside the box, m²
};

/// Exact volume and surface of the union of the spheres inside the box: each sphere's part in its own
/// power cell, which its walls and the radical planes of its overlaps cut. Those cuts are summed over
/// the orthoschemes (sphere, edge, facet, cell) of the triangulation.
/// `vertices` are what the network's vertices stand for, `spheres` the packing's own (the same without
/// periodic axes).
SolidUnion solid_union(const PoreNetwork& network, const Spheres& vertices,
                       const Spheres& spheres);
/// The part of each sphere of the packing: what of the union lies in its power cell.
std::vector<SolidUnion> solid_parts(const PoreNetwork& network, const Spheres& vertices,
                                    const Spheres& spheres);

/// What the spheres' wedges in each pore hold beyond the union, m³: where spheres overlap each other or a wall, wedges
/// count twice or stick out.
std::vector<double> doubled_volumes(const PoreNetwork& network, const Spheres& vertices,
                                    const Spheres& spheres);

}  // namespace pfv
