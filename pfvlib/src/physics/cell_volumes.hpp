// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <array>

namespace pfv {

/// Volume of a cell and its derivatives with respect to the positions of its vertices (for a wall:
/// its position along its outward normal, times that normal). The cell is the tetrahedron of four
/// centres, the prism under three of them on a wall, the slab between two centres and an edge of the
/// box, or the block in a corner.
struct CellVolume {
  double volume = 0.0;                      ///< m³, solid included
  std::array<Eigen::Vector3d, 4> gradient;  ///< dV/dx of each vertex, m²
};

CellVolume cell_volume(const std::array<Vertex, 4>& cell, const Spheres& spheres);

}  // namespace pfv
