// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace pfv {

/// Equal cells that fill the flow box, x running fastest, in coordinates from its lower corner, m.
struct Grid {
  std::array<int, 3> counts{1, 1, 1};
  Eigen::Vector3d lengths = Eigen::Vector3d::Ones();  ///< edges of a cell

  int size() const { return counts[0] * counts[1] * counts[2]; }
  int index(const std::array<int, 3>& place) const {
    return place[0] + counts[0] * (place[1] + counts[1] * place[2]);
  }
  std::array<int, 3> place(int cell) const {
    return {cell % counts[0], cell / counts[0] % counts[1], cell / counts[0] / counts[1]};
  }
  Eigen::Vector3d centre(int cell) const {
    const auto [i, j, k] = place(cell);
    return (Eigen::Array3d(i, j, k) + 0.5).matrix().cwiseProduct(lengths);
  }
  double volume() const { return lengths.prod(); }
  double face_area(int axis) const { return volume() / lengths[axis]; }
  /// Step of the index from a cell to the next along an axis.
  int stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? counts[0] : counts[0] * counts[1];
  }
  /// The cell behind a face of a cell, or -1 outside the box.
  int neighbour(int cell, Face face) const {
    const int axis = axis_of(face), i = place(cell)[axis];
    if (i == (is_upper(face) ? counts[axis] - 1 : 0)) return -1;
    return is_upper(face) ? cell + stride(axis) : cell - stride(axis);
  }
  /// The cell that holds a place; places outside belong to the nearest.
  int cell_at(const Eigen::Vector3d& place) const;
};

Grid make_grid(const Container& box, const std::array<int, 3>& counts);

/// Where the box ends: one entry a cell face on it, by face and then by cell. Boundary number f < 6
/// is face f, 6 + i is patch i.
struct GridFace {
  int cell;
  Face face;
  int boundary;
};

/// Which face or patch each of them belongs to, by its middle (the rules of `Patch`).
std::vector<GridFace> boundary_faces(const Grid& grid, const Container& box);

/// Middle of a cell face on the box, from the box's lower corner.
Eigen::Vector3d middle_of(const Grid& grid, const GridFace& face);

}  // namespace pfv
