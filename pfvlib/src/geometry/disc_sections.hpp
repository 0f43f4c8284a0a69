// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

namespace pfv {

/// A convex polygon of at most eight corners, in order (counterclockwise for a positive area).
struct Polygon {
  std::array<Eigen::Vector2d, 8> corners;
  int size = 0;

  void add(const Eigen::Vector2d& corner) { corners[size++] = corner; }
};

/// The part of a convex polygon where normal . x <= offset.
Polygon clip(const Polygon& polygon, const Eigen::Vector2d& normal, double offset);

/// Area (m²) of a flat figure and its first moment about the origin (m³): area times centroid.
struct Section {
  double area = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
};

/// What a polygon and the disc of the given radius about the origin have in common.
Section section_in_disc(const Polygon& polygon, double radius);

}  // namespace pfv
