// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "network/triangulation.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

struct CellCentres {
  /// Dual vertex of each cell: the point with equal power to its spheres that lies on its walls, in
  /// the coordinates of `spheres`, m.
  Eigen::Matrix3Xd places;
  /// Cells whose four vertices lie in one plane but for rounding or a tiny displacement (a lattice has
  /// many): their dual vertex may be anywhere on the dual edge between the cells on either side.
  std::vector<char> flat;
};

/// Cells that double precision cannot resolve are solved in extended precision: the error stays below
/// 1e-12 of the cell's size.
CellCentres cell_centres(const Triangulation& triangulation, const Spheres& spheres);

}  // namespace pfv
