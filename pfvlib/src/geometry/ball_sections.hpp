// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace pfv {

struct BallSection {
  double volume = 0.0;  ///< m³
  double area = 0.0;    ///< m² of the ball's surface
};

/// What a plane takes from a ball within one orthoscheme: the ball of the given radius is centred at
/// the scheme's first corner, the next three corners are reached by three steps a, b, c >= 0 normal
/// to each other, and the plane, through those three corners, is normal to the first step. Returned
/// is the part of the ball within the cone on the triangle that lies beyond the plane (volume, and
/// area of the ball's surface). Zero for radius <= a. Exact: the integral over the polar angle is
/// elementary.
BallSection beyond_plane(double radius, double a, double b, double c);

}  // namespace pfv
