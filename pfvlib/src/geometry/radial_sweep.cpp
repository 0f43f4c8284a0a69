// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/radial_sweep.hpp"

#include <cmath>

namespace pfv {

namespace {

/// log(1 + x) / x.
double log_ratio(double x) { return x == 0.0 ? 1.0 : std::log1p(x) / x; }

/// Integral of dt / rho over a segment of the given length in the section, whose ends have the coordinates u
/// along it and the distances rho from the axis. Where it comes towards the axis it is taken from the other end,
/// so that nothing cancels.
double integral_of_inverse(double ua, double ub, double rho_a, double rho_b, double length) {
  if (ua < 0.0 && ub < -ua) return integral_of_inverse(-ub, -ua, rho_b, rho_a, length);
  const double start = ua + rho_a;
  if (!(start > 0.0)) return 0.0;
  const double slope = (1.0 + (ua + ub) / (rho_a + rho_b)) / start;
  return slope * log_ratio(slope * length);
}

}  // namespace

RadialSweep::RadialSweep(const RoundPlace& a, const RoundPlace& b) {
  const Eigen::Vector2d &A = a.in_section, way = b.in_section - A;
  const double length = way.norm(), rho_a = A.norm(), rho_b = b.in_section.norm();
  const Eigen::Vector2d along = length > 0.0 ? Eigen::Vector2d(way / length) : Eigen::Vector2d::UnitX();
  rise = b.height - a.height;
  mean_height = 0.5 * (a.height + b.height);
  // distance d of the line from the axis, signed; ends at u along it
  const double d = A.x() * along.y() - A.y() * along.x();
  const double ua = A.dot(along), ub = ua + length;
  twice_area = d * length;
  angle = std::atan2(twice_area, A.dot(b.in_section));
  // integral of t d theta = d/(2 L) ln(rho_b² / rho_a²) - ua / L angle
  const double growth = rho_a > 0.0 ? (ua + ub) / (rho_a * rho_a) : 0.0;
  const double angle_t =
      length > 0.0 ? 0.5 * d * growth * log_ratio(growth * length) - ua * (angle / length) : 0.5 * angle;
  height_angle = a.height * angle + rise * angle_t;
  if (!(rho_a + rho_b > 0.0)) return;
  const Eigen::Vector2d across = A - ua * along;  // the line's point nearest to the axis
  const double inverse = integral_of_inverse(ua, ub, rho_a, rho_b, length);
  const double growth_of_rho = (ua + ub) / (rho_a + rho_b);  // (rho_b - rho_a) / L
  direction = inverse * across + growth_of_rho * along;
  constexpr double short_length = 0.05;
  if (length > short_length * (rho_a + rho_b)) {
    const double d2 = d * d, squares = 0.5 * (ub * rho_b - ua * rho_a - d2 * inverse * length) / length;
    direction_t = ((growth_of_rho - ua * inverse) * across + (squares - ua * growth_of_rho) * along) / length;
  } else {  // where the closed form would lose digits, Gauss' rule of five points has them all
    constexpr double nodes[] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
    constexpr double weights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                                  0.2369268850561891};
    for (int i = 0; i < 5; ++i) {
      const double t = 0.5 + 0.5 * nodes[i];
      direction_t += 0.5 * weights[i] * t * (A + t * way).normalized();
    }
  }
}

}  // namespace pfv
