// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/mesh_walls.hpp"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace pfv {

/// A connected part of a mesh.
struct MeshPart {
  std::vector<Triangle> triangles;  ///< of a closed part with normals (of their order) that point out of it
  bool closed = false;
  double area = 0.0;                                  ///< m²
  double volume = 0.0;                                ///< m³; 0 for an open part
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of the volume, or of an open part's area, m
  std::vector<std::array<Eigen::Vector3d, 2>> edges;  ///< that bound it, or at which it turns by 30 degrees or more
};

/// Triangles with a common edge (corners the same to `planarity` of the mesh's size) are of one part, which is closed
/// where each of its edges joins two of them. Triangles without area are left out.
std::vector<MeshPart> parts_of_mesh(const std::vector<Triangle>& triangles);

/// Half the cross product of two edges.
Eigen::Vector3d area_vector(const Triangle& triangle);
/// Longest edge of the box around them.
double size_of(const std::vector<Triangle>& triangles);

}  // namespace pfv
