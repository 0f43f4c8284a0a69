// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// What a container measures.
struct ContainerGeometry {
  double volume = 0.0;        ///< m³
  std::vector<double> areas;  ///< of the faces, m²
  /// Of each face: the integral of its outward normal n (m²) and of x cross n about the place asked for (m³):
  /// force and moment of a unit pressure on it.
  Eigen::Matrix<double, 6, Eigen::Dynamic> loads;
  std::vector<std::vector<Eigen::Vector3d>> polygons;  ///< corners of plane faces of a polyhedron, m
};

/// Throws InputError for a container that is open or empty. Cost: faces², but for a box.
ContainerGeometry geometry_of(const Container& container, const Eigen::Vector3d& origin);

/// With the surfaces and pivots of its faces where they are after some time of their motion (s; may be negative); the bounds
/// stay as they were.
Container container_after(const Container& container, double time);
/// What `geometry_of` gives when the faces have gone on moving as they do for `time` (s; may be negative).
ContainerGeometry geometry_after(const Container& container, double time, const Eigen::Vector3d& origin);
/// All that `check` does but for measuring the faces: for a container whose faces are where they have been checked.
void check_conditions(const Container& container);

/// Whether a face moves.
bool any_face_moves(const Container& container);

/// The periodic axis that a face bounds, of which it is an end and no wall, or -1.
int periodic_axis(const Container& container, int face);
/// The two ends of a cylinder: planes square to its axis, the one at the start of the axis first.
std::array<int, 2> ends_of_cylinder(const Container& container);
/// The cylinder among the faces, if there is one.
std::optional<int> cylinder_of(const Container& container);

}  // namespace pfv
