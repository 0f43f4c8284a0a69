// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/ball_sections.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

BallSection beyond_plane(double radius, double a, double b, double c) {
  if (radius <= a || b <= 0.0 || c <= 0.0) return {};
  const double circle2 = radius * radius - a * a;  // of the circle cut into the plane
  const double circle = std::sqrt(circle2);
  const double cube = radius * radius * radius / 3.0;
  const double phi = std::atan2(c, b);

  // within phi_edge the triangle ends (at distance b / cos phi) before the circle does
  const double phi_edge = circle > b ? std::min(phi, std::acos(b / circle)) : 0.0;
  BallSection section;
  if (phi_edge > 0.0) {
    const double cosines = std::asin(a * std::sin(phi_edge) / std::hypot(a, b));
    section.volume += cube * (phi_edge - cosines) - a * b * b * std::tan(phi_edge) / 6.0;
    section.area += radius * radius * (phi_edge - cosines);
  }
  const double arc = phi - phi_edge;
  section.volume += arc * (cube * (1.0 - a / radius) - a * circle2 / 6.0);
  section.area += arc * radius * (radius - a);
  return section;
}

}  // namespace pfv
