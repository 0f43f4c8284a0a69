// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace pfv {

/// A place near a cylinder: in its section, from the axis, and along the axis, m.
struct RoundPlace {
  Eigen::Vector2d in_section;
  double height;
};

/// What a segment sweeps as it moves straight away from the axis of a cylinder, in each place along its own
/// radius, out to the wall: the facets between two spheres and a round wall are such surfaces, and all that is
/// measured of cells, facets and bases at such a wall is a sum over the segments around it.
///
/// theta is the angle around the axis, z the height, t from 0 at `a` to 1 at `b`, r(t) the unit vector away from
/// the axis. All are exact, also for segments that are short, steep or nearly parallel to the axis.
struct RadialSweep {
  double angle = 0.0;       ///< integral of d theta
  double height_angle = 0.0;  ///< integral of z d theta, m
  double twice_area = 0.0;    ///< integral of rho² d theta: twice the area between axis and segment, m²
  double rise = 0.0;          ///< of z, m
  double mean_height = 0.0;   ///< m
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();     ///< integral of r dt
  Eigen::Vector2d direction_t = Eigen::Vector2d::Zero();   ///< integral of t r dt

  RadialSweep(const RoundPlace& a, const RoundPlace& b);

  /// Area (m²) between the segment's trace on the wall and the height `z` there, counted as positive where theta
  /// falls with z above the trace.
  double wall_area_below(double z, double radius) const { return radius * (height_angle - z * angle); }
  /// Area between the segment's own trace on a plane square to the axis and the wall.
  double end_area(double radius) const { return 0.5 * (radius * radius * angle - twice_area); }
  /// Volume between the segment's sweep, the plane at height z and the wall.
  double volume_below(double z, double radius) const {
    return 0.5 * (radius * radius * (height_angle - z * angle) - twice_area * (mean_height - z));
  }
};

}  // namespace pfv
