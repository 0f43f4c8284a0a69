// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/disc_sections.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

double cross(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return p.x() * q.y() - p.y() * q.x();
}

double sector(const Eigen::Vector2d& p, const Eigen::Vector2d& q, double radius) {
  return 0.5 * radius * radius * std::atan2(cross(p, q), p.dot(q));
}

/// Signed area common to the disc and the triangle (origin, p, q).
double triangle_in_disc(const Eigen::Vector2d& p, const Eigen::Vector2d& q, double radius) {
  const Eigen::Vector2d edge = q - p;
  const double length2 = edge.squaredNorm();
  if (length2 == 0.0) return 0.0;
  // where the edge's line p + s edge meets the circle
  const double middle = -p.dot(edge) / length2;
  const double discriminant =
      middle * middle - (p.squaredNorm() - radius * radius) / length2;
  if (discriminant <= 0.0) return sector(p, q, radius);
  const double half = std::sqrt(discriminant);
  const double enter = std::max(0.0, middle - half), leave = std::min(1.0, middle + half);
  if (enter >= leave) return sector(p, q, radius);
  const Eigen::Vector2d in = p + enter * edge, out = p + leave * edge;
  double area = 0.5 * cross(in, out);
  if (enter > 0.0) area += sector(p, in, radius);
  if (leave < 1.0) area += sector(out, q, radius);
  return area;
}

}  // namespace

Polygon clip(const Polygon& polygon, const Eigen::Vector2d& normal, double offset) {
  Polygon kept;
  for (int i = 0; i < polygon.size; ++i) {
    const Eigen::Vector2d& p = polygon.corners[i];
    const Eigen::Vector2d& q = polygon.corners[(i + 1) % polygon.size];
    const double dp = offset - normal.dot(p), dq = offset - normal.dot(q);
    if (dp >= 0.0) kept.add(p);
    if ((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0)) kept.add(p + dp / (dp - dq) * (q - p));
  }
  return kept;
}

double area_in_disc(const Polygon& polygon, double radius) {
  double area = 0.0;
  for (int i = 0; i < polygon.size; ++i)
    area += triangle_in_disc(polygon.corners[i], polygon.corners[(i + 1) % polygon.size], radius);
  return std::max(area, 0.0);
}

}  // namespace pfv
