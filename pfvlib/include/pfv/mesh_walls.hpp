// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pfv {

/// A triangle of a mesh: its corners are the columns, m.
using Triangle = Eigen::Matrix3d;

/// Three corners of a mesh, by triangle and corner, and where they were when its walls were found, m.
struct MeshAnchors {
  std::array<std::pair<int, int>, 3> corners{};
  Eigen::Matrix3d places = Eigen::Matrix3d::Zero();
};

/// A wall that a mesh is, or one of several.
struct MeshWall {
  Surface surface;             ///< of several, with the mesh on its inner side
  std::vector<int> triangles;  ///< that lie on it, by their numbers
  double deviation = 0.0;      ///< m; the furthest that they lie from it
  std::optional<MeshAnchors> anchors;  ///< of walls that stand in place of a round mesh's triangles
};

/// Nodes may stray this much from a plane, as a part of the mesh's size: STL files carry some seven digits.
inline constexpr double planarity = 1e-6;

/// Whether many flats around an axis are one round wall.
enum class RoundMeshes { as_cylinders, as_flats };

/// The walls of a mesh that bounds a convex room, open or closed: its planes, in the order of their first
/// triangles; and where sixteen or more of them go around an axis at one distance, and others of the mesh are
/// square to it, the cylinder of the same cross-section in their place. A mesh of revolution whose triangles form no
/// convex flats, or too many (a remeshed tube, a silo of 80 flats around), is a cylinder, or 16 to 32 flats around
/// each cylinder and cone of it.
///
/// Nodes may stray from their plane by `planarity`. Throws
/// InputError, which begins with `what` and names a triangle, for a mesh that is not convex or has no
/// area. Costs triangles times planes.
std::vector<MeshWall> walls_of_mesh(const std::vector<Triangle>& triangles, RoundMeshes round,
                                    const std::string& what);

/// Planes around a cylinder, which touch it: they cut off nothing from spheres within it. They look the ways of `beside`,
/// planes of a cone below it for instance, where 16 or more of those go around evenly; else there are 32 equal ones.
std::vector<Surface> flats_around(const Surface& cylinder, const std::vector<Surface>& beside);

/// The same wall where its triangles are now, after a motion as a rigid body; `several`: the mesh has others.
void follow_mesh(MeshWall& wall, const std::vector<Triangle>& triangles, bool several);

}  // namespace pfv
