// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/disc_sections.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

double cross(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return p.x() * q.y() - p.y() * q.x();
}

/// The sector of the disc from the direction of p to that of q: its moment is r³/3 times the integral of the
/// directions between them.
void add_sector(Section& sum, const Eigen::Vector2d& p, const Eigen::Vector2d& q, double radius) {
  sum.area += 0.5 * radius * radius * std::atan2(cross(p, q), p.dot(q));
  const Eigen::Vector2d turn = q.normalized() - p.normalized();
  sum.moment += radius * radius * radius / 3.0 * Eigen::Vector2d(turn.y(), -turn.x());
}

void add_triangle(Section& sum, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const double area = 0.5 * cross(p, q);
  sum.area += area;
  sum.moment += area / 3.0 * (p + q);
}

/// What the disc and the triangle (origin, p, q) have in common, signed.
void add_triangle_in_disc(Section& sum, const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                          double radius) {
  const Eigen::Vector2d edge = q - p;
  const double length2 = edge.squaredNorm();
  if (length2 == 0.0) return;
  // where the edge's line p + s edge meets the circle
  const double middle = -p.dot(edge) / length2;
  const double discriminant =
      middle * middle - (p.squaredNorm() - radius * radius) / length2;
  if (discriminant <= 0.0) return add_sector(sum, p, q, radius);
  const double half = std::sqrt(discriminant);
  const double enter = std::max(0.0, middle - half), leave = std::min(1.0, middle + half);
  if (enter >= leave) return add_sector(sum, p, q, radius);
  const Eigen::Vector2d in = p + enter * edge, out = p + leave * edge;
  add_triangle(sum, in, out);
  if (enter > 0.0) add_sector(sum, p, in, radius);
  if (leave < 1.0) add_sector(sum, out, q, radius);
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

Section section_in_disc(const Polygon& polygon, double radius) {
  Section sum;
  for (int i = 0; i < polygon.size; ++i)
    add_triangle_in_disc(sum, polygon.corners[i], polygon.corners[(i + 1) % polygon.size], radius);
  if (sum.area <= 0.0) return {};
  return sum;
}

}  // namespace pfv
