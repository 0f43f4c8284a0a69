// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/mesh_walls.hpp"

#include <optional>
#include <vector>

namespace pfv {

/// The walls of a mesh of revolution with a convex room, open or closed by discs square to its axis, however its triangles
/// lie on it: a cylinder, or equal flats around each cylinder and cone that it is made of (32, 24 around each of two, 16 of three). Nothing for
/// another shape, and where fewer than some 16 triangles go around.
std::optional<std::vector<MeshWall>> walls_of_revolution(const std::vector<Triangle>& triangles, RoundMeshes round);

}  // namespace pfv
