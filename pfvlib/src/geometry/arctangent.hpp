// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/pi.hpp"

#include <cmath>

namespace pfv {

/// atan2(y, x) without branches, so that loops over it become vector instructions; to three units in the
/// last place for arguments that are not tiny or huge. Rational approximation of Moshier's Cephes
/// library, 1989.
inline double arctangent(double y, double x) {
  constexpr double tangent_of_eighth = 0.41421356237309503;
  const double ax = std::abs(x), ay = std::abs(y);
  const double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  const bool high = small > tangent_of_eighth * large;
  const double part = high ? small - large : small;
  const double whole = high ? small + large : large;
  const double t = part / (whole > 0.0 ? whole : 1.0), z = t * t;
  const double p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z -
                     7.500855792314704667340e1) * z - 1.228866684490136173410e2) * z -
                   6.485021904942025371773e1;
  const double q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
                     4.328810604912902668951e2) * z + 4.853903996359136964868e2) * z +
                   1.945506571482613964425e2;
  const double low = t + t * (z * p / q);
  const double eighth = high ? 0.25 * pi + low : low;
  const double quarter = ay > ax ? 0.5 * pi - eighth : eighth;
  const double half = x < 0.0 ? pi - quarter : quarter;
  return y < 0.0 ? -half : half;
}

}  // namespace pfv
