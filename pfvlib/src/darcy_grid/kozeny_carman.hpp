// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace pfv {

/// Above this porosity the permeability stays what it is there (the Darcy example of PFC).
inline constexpr double largest_porosity = 0.7;
/// Below this one, too: a cell inside a grain keeps a little permeability, so that the system stays
/// definite. No packing of grains smaller than the cells comes near it.
inline constexpr double smallest_porosity = 0.05;

inline double bounded_porosity(double porosity) {
  return std::clamp(porosity, smallest_porosity, largest_porosity);
}

/// Permeability (m²) of grains of diameter d: e³ d² / (180 (1 - e)²), with e the bounded porosity.
inline double kozeny_carman(double porosity, double diameter) {
  const double e = bounded_porosity(porosity);
  return e * e * e * diameter * diameter / (180.0 * (1.0 - e) * (1.0 - e));
}

}  // namespace pfv
