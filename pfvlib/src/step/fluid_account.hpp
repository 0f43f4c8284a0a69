// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"

namespace pfv {

/// Where the fluid is: the balance that a continuity which is exact at each step does not show. A volume is
/// that of the fluid without pressure.
struct FluidAccount {
  bool open = false;
  double at_start = 0.0;  ///< in the box at the first solve, m³
  double came_in = 0.0;   ///< since then, less what left, m³
  double ahead = 0.0;     ///< what of it belongs to the motion that a long step has begun, m³
  bool within_long_step = false;  ///< whether the last step was one
};

/// Volume of the fluid in a box: the box less the whole volumes of the grains with their centre in it, whether
/// they overlap (that is deformation of a contact) or cross a face, m³; of those in rigid bodies what they displace.
/// May be negative for nested grains.
double fluid_space(double box_volume, const Spheres& spheres);

/// What the grains displace that are in `now` and not in `before`, less those that have gone, m³.
double displaced_by_newcomers(const Spheres& before, const Spheres& now);

/// By how much those that are in both have grown, m³.
double growth_of_grains(const Spheres& before, const Spheres& now);

}  // namespace pfv
