// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/ball_sections.hpp"

#include <Eigen/Core>

namespace pfv {

/// Part of a ball about the origin where x > a, y > b and z > c: its volume and the area of the
/// ball's surface in it. Exact for any corner (a, b, c), -infinity included: the divergence theorem
/// gives the volume from that area and from the three plane sections, Gauss-Bonnet the area from
/// the three circles that bound it. Rounding is some 1e-15 of the ball.
BallSection beyond_corner(double radius, const Eigen::Vector3d& corner);

}  // namespace pfv
