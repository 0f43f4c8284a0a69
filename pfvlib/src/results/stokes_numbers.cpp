// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/stokes_numbers.hpp"

#include "geometry/pi.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

StokesNumbers stokes_numbers(const Packing& grains, const Eigen::Ref<const Eigen::VectorXd>& masses, double viscosity) {
  StokesNumbers found;
  for (Eigen::Index k = 0; k < grains.velocities.cols(); ++k) {
    const bool single = grains.bodies.size() == 0 || grains.bodies[k] < 0;
    if (!single || !std::isfinite(masses[k]) || !(grains.radii[k] > 0.0)) continue;
    const double speed = grains.velocities.col(k).norm();
    const double stokes = masses[k] * speed / (6.0 * pi * viscosity * grains.radii[k] * grains.radii[k]);
    found.largest = std::max(found.largest, stokes);
    found.mean += masses[k] * stokes;
    found.mass += masses[k];
  }
  if (found.mass > 0.0) found.mean /= found.mass;
  return found;
}

}  // namespace pfv
