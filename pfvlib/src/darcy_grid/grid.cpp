// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/grid.hpp"

#include "network/pore_boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// Extent of a patch along the two axes of its face, from the box's lower corner.
struct Rectangle {
  int axis_a, axis_b;
  double a0, a1, b0, b1;
};

Rectangle rectangle_of(const ContainerPatch& patch, const Container& box) {
  const int axis = axis_of(static_cast<Face>(patch.face));
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  const Eigen::Vector3d lower = patch.lower - box.lower, upper = patch.upper - box.lower;
  return {a, b, lower[a], upper[a], lower[b], upper[b]};
}

void apply(const ContainerPatch& patch, int number, const Grid& grid, const Container& box,
           std::vector<GridFace>& faces) {
  const Rectangle r = rectangle_of(patch, box);
  // borders belong to the patch, rounding or not
  const double slack_a = 1e-9 * grid.lengths[r.axis_a], slack_b = 1e-9 * grid.lengths[r.axis_b];
  GridFace* nearest = nullptr;
  double smallest = std::numeric_limits<double>::infinity();
  bool any = false;
  for (GridFace& face : faces) {
    if (static_cast<int>(face.face) != patch.face) continue;
    const Eigen::Vector3d x = middle_of(grid, face);
    const double a = x[r.axis_a], b = x[r.axis_b];
    if (a >= r.a0 - slack_a && a <= r.a1 + slack_a && b >= r.b0 - slack_b && b <= r.b1 + slack_b) {
      face.boundary = number;
      any = true;
    }
    const double distance = std::hypot(a - 0.5 * (r.a0 + r.a1), b - 0.5 * (r.b0 + r.b1));
    if (distance < smallest) {
      smallest = distance;
      nearest = &face;
    }
  }
  if (!any) nearest->boundary = number;
}

}  // namespace

int Grid::cell_at(const Eigen::Vector3d& position) const {
  std::array<int, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = counts[axis] - 1;
    at[axis] = static_cast<int>(std::clamp(std::floor(position[axis] / lengths[axis]), 0.0, last));
  }
  return index(at);
}

Grid make_grid(const Container& box, const std::array<int, 3>& counts) {
  Grid grid;
  grid.counts = counts;
  for (int axis = 0; axis < 3; ++axis)
    grid.lengths[axis] = (box.upper[axis] - box.lower[axis]) / counts[axis];
  return grid;
}

Eigen::Vector3d middle_of(const Grid& grid, const GridFace& face) {
  return grid.centre(face.cell) +
         0.5 * grid.lengths.cwiseProduct(outward_normal(face.face));
}

std::vector<GridFace> boundary_faces(const Grid& grid, const Container& box) {
  std::vector<GridFace> faces;
  for (const Face face : all_faces)
    for (int cell = 0; cell < grid.size(); ++cell)
      if (grid.neighbour(cell, face) < 0) faces.push_back({cell, face, static_cast<int>(face)});
  for (std::size_t i = 0; i < box.patches.size(); ++i)
    apply(box.patches[i], patch_number(box, i), grid, box, faces);
  return faces;
}

}  // namespace pfv
