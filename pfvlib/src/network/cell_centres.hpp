// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "network/triangulation.hpp"

#include <Eigen/Core>

namespace pfv {

/// Dual vertex of each cell: the point with equal power to its spheres that lies on its walls, in
/// the coordinates of `spheres`, m. Cells that double precision cannot resolve (slivers) are solved
/// in extended precision. Error below 1e-12 of the cell's size.
Eigen::Matrix3Xd cell_centres(const Triangulation& triangulation, const Spheres& spheres);

}  // namespace pfv
