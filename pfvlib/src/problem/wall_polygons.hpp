// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

using Polygon3 = std::vector<Eigen::Vector3d>;

/// A polygon of a face, counterclockwise as seen from outside.
struct WallPolygon {
  int face;
  Polygon3 corners;
};

/// The walls of a container: a plane's part of it, a cylinder as 96 strips and two polygons, each with its corners on it;
/// none along periodic axes and of faces that bound nothing. Throws InputError for a container that is not closed.
std::vector<WallPolygon> wall_polygons(const Container& container);

/// The point where three planes meet; where they do so at a small angle, to round-off on all three.
Eigen::Vector3d corner_of_planes(const Surface& a, const Surface& b, const Surface& c);

/// The part of a polygon on the fluid's side of a plane.
Polygon3 clip(const Polygon3& polygon, const Surface& plane);

}  // namespace pfv
