// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/radial_sweep.hpp"
#include "network/spheres.hpp"

#include <array>

namespace pfv {

// Cells at a round wall (a cylinder between two planes square to its axis): they reach from their spheres straight
// away from the axis to the wall, so that facets are swept by segments (geometry/radial_sweep.hpp) and volumes,
// areas and vector areas of the cells add up to those of the cylinder to round-off.

inline bool is_round(Vertex vertex, const Spheres& spheres) {
  return is_wall(vertex) && !spheres.wall(vertex).is_plane();
}
/// A facet between two spheres and a round wall.
inline bool is_swept(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  return is_round(facet[2], spheres) && !is_wall(facet[1]);
}
/// Any facet that has a round wall.
inline bool touches_round_wall(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  return is_round(facet[2], spheres) || is_round(facet[1], spheres);
}
/// A cell's round wall, by its place among the vertices, or -1.
int round_corner(const std::array<Vertex, 4>& cell, const Spheres& spheres);

/// Area vector (m²) of a swept facet.
Eigen::Vector3d swept_area(const std::array<Vertex, 3>& facet, const Spheres& spheres);

/// Volume (m³) of the cone from a swept facet to a place; positive where the place lies ahead of the facet.
double cone_on_swept(const std::array<Vertex, 3>& facet, const Spheres& spheres, const Eigen::Vector3d& place);
/// Between a facet at a round wall and a place on it: area on each corner of the facet that is a wall, m².
/// `side`: 0 for a place behind the facet, 1 for one ahead of it.
std::array<double, 3> strips_on_walls(const std::array<Vertex, 3>& facet, const Spheres& spheres,
                                      const Eigen::Vector3d& place, int side);

/// Volume of a cell at a round wall, m³.
double round_cell_volume(const std::array<Vertex, 4>& cell, const Spheres& spheres);

/// The part of a wall that a cell rests on.
struct WallPart {
  double area;             ///< m²
  Eigen::Vector3d vector;  ///< integral of the outward normal, m²
  Eigen::Vector3d moment;  ///< of a unit pressure about the origin of the spheres' coordinates, m³
};
/// Of a cell at a round wall: what it rests on at its corner i, that wall or an end of it.
WallPart round_base(const std::array<Vertex, 4>& cell, int i, const Spheres& spheres);

}  // namespace pfv
