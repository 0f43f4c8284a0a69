// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace pfv {

// The order of all that a network numbers: from the spheres' ids and places and the box's edges alone,
// so that no byte depends on who triangulated, or on the order of a packing's rows.

/// Number of a place of a grid of 2^16 places an axis along a Hilbert curve (Skilling 2004).
std::uint64_t hilbert_number(std::array<std::uint32_t, 3> place);

/// Of each sphere the number of its place along a Hilbert curve whose grid of cubes fits the box's longest edge.
std::vector<std::uint64_t> curve_numbers(const Spheres& spheres);

/// The spheres along a Hilbert curve whose grid of cubes fits the box's longest edge (what stands outside
/// counts as at the border); those of one cube by `precedes`. Places that are near stand near in memory.
std::vector<Vertex> along_curve(const Spheres& spheres);

/// Spheres by their ids, the images of one sphere by their places; then walls in their order.
inline bool precedes(Vertex a, Vertex b, const Spheres& spheres) {
  if (is_wall(a) || is_wall(b)) return a > b;
  if (spheres.ids[a] != spheres.ids[b]) return spheres.ids[a] < spheres.ids[b];
  for (int axis = 0; axis < 3; ++axis)
    if (spheres.centres(axis, a) != spheres.centres(axis, b))
      return spheres.centres(axis, a) < spheres.centres(axis, b);
  return false;
}

/// Puts a positively oriented cell's vertices in the order of `precedes`, with what stands opposite them,
/// and then, where the orientation asks for it, the last two spheres the other way round (with fewer than
/// three spheres, the last two walls). So every facet begins with its first sphere, too.
void arrange(std::array<Vertex, 4>& vertices, std::array<int, 4>& opposite, const Spheres& spheres);

/// The cells in order: by the first of their spheres along the curve, then by the second, and so on, walls
/// last. A vertex k >= 0 counts here as the k-th of `spheres` along the curve.
std::vector<int> order_of_cells(const std::vector<std::array<Vertex, 4>>& cells, int spheres);

/// The vertices of a cell by the ids of their spheres, ascending, walls first: the same for all images of a cell and on
/// all ranks.
using CellName = std::array<std::int64_t, 4>;
CellName cell_name(const std::array<Vertex, 4>& cell, const Spheres& spheres);

/// Columns by the ids of their spheres.
void sort_by_ids(std::vector<int>& columns, const Spheres& spheres);

}  // namespace pfv
