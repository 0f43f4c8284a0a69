// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/ball_corner.hpp"

#include "geometry/pi.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

BallSection operator-(const BallSection& one, const BallSection& other) {
  return {one.volume - other.volume, one.area - other.area};
}

/// The unit ball where x > a, 0 <= a < 1.
BallSection cap(double a) {
  return {pi / 3.0 * (1.0 - a) * (1.0 - a) * (2.0 + a), 2.0 * pi * (1.0 - a)};
}

/// Radius of the circle that the plane x = a cuts out of the unit ball.
double circle(double a) { return std::sqrt((1.0 - a) * (1.0 + a)); }

double arc_cosine(double ratio) { return std::acos(std::clamp(ratio, -1.0, 1.0)); }

/// Angle through which the boundary turns where the circles x = a and y = b meet.
double turn(double a, double b) { return arc_cosine(-a * b / (circle(a) * circle(b))); }

/// The unit ball where x > a and y > b, both >= 0: a lune, zero where the edge misses the ball.
BallSection lune(double a, double b) {
  if (a * a + b * b >= 1.0) return {};
  const auto on_plane = [](double height, double other, double& angle) {
    const double rho = circle(height);
    angle = 2.0 * arc_cosine(other / rho);
    return 0.5 * rho * rho * angle -
           other * std::sqrt(std::max((rho - other) * (rho + other), 0.0));
  };
  double angle_a, angle_b;
  const double section_a = on_plane(a, b, angle_a), section_b = on_plane(b, a, angle_b);
  const double area = 2.0 * pi - a * angle_a - b * angle_b - 2.0 * turn(a, b);
  return {(area - a * section_a - b * section_b) / 3.0, area};
}

/// The unit ball where x > a, y > b and z > c, all >= 0: zero where the corner is not in the ball.
BallSection triangle(const Eigen::Vector3d& corner) {
  if (corner.squaredNorm() >= 1.0) return {};
  double area = 2.0 * pi, sections = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double a = corner[i], b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
    const double rho = circle(a);
    const double angle = arc_cosine(b / rho) - std::asin(std::clamp(c / rho, -1.0, 1.0));
    const double half_b = std::sqrt(std::max((rho - b) * (rho + b), 0.0));
    const double half_c = std::sqrt(std::max((rho - c) * (rho + c), 0.0));
    sections += 0.5 * a * (rho * rho * angle - b * (half_b - c) - c * (half_c - b));
    area -= a * angle + turn(a, b);
  }
  return {(area - sections) / 3.0, area};
}

// A negative coordinate is reflected: what lies beyond it is everything minus what lies beyond the
// mirrored plane.

BallSection beyond(double a) {
  if (a >= 1.0) return {};
  if (a <= -1.0) return {4.0 / 3.0 * pi, 4.0 * pi};
  return a >= 0.0 ? cap(a) : BallSection{4.0 / 3.0 * pi, 4.0 * pi} - cap(-a);
}

BallSection beyond(double a, double b) {
  if (a >= 1.0 || b >= 1.0) return {};
  if (a <= -1.0) return beyond(b);
  if (b <= -1.0) return beyond(a);
  if (a < 0.0) return beyond(b) - beyond(-a, b);
  if (b < 0.0) return beyond(a) - beyond(a, -b);
  return lune(a, b);
}

BallSection beyond(const Eigen::Vector3d& corner) {
  if (corner.maxCoeff() >= 1.0) return {};
  for (int i = 0; i < 3; ++i) {
    if (corner[i] >= 0.0) continue;
    const double b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
    if (corner[i] <= -1.0) return beyond(b, c);
    Eigen::Vector3d mirrored = corner;
    mirrored[i] = -corner[i];
    return beyond(b, c) - beyond(mirrored);
  }
  return triangle(corner);
}

}  // namespace

BallSection beyond_corner(double radius, const Eigen::Vector3d& corner) {
  const BallSection section = beyond(corner / radius);
  return {section.volume * radius * radius * radius, section.area * radius * radius};
}

}  // namespace pfv
