// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/solid_overlaps.hpp"

#include "geometry/ball_corner.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// The cells along one axis that a sphere reaches, first <= i < last.
struct Range {
  int first, last;
  int nodes() const { return last - first + 1; }
};

Range reach(double centre, double radius, double length, int count) {
  const double low = std::floor((centre - radius) / length);
  const double high = std::floor((centre + radius) / length);
  return {static_cast<int>(std::clamp(low, 0.0, count - 1.0)),
          static_cast<int>(std::clamp(high, 0.0, count - 1.0)) + 1};
}

/// What lies beyond each node of a sphere's cells; a cell is an alternating sum over its corners.
class Corners {
 public:
  Corners(const Eigen::Vector3d& centre, double radius, const Grid& grid,
          const std::array<Range, 3>& ranges)
      : ranges_(ranges) {
    const auto node = [&](int axis, int i) { return i * grid.lengths[axis] - centre[axis]; };
    for (int k = ranges[2].first; k <= ranges[2].last; ++k)
      for (int j = ranges[1].first; j <= ranges[1].last; ++j)
        for (int i = ranges[0].first; i <= ranges[0].last; ++i)
          beyond_.push_back(beyond_corner(radius, {node(0, i), node(1, j), node(2, k)}));
  }

  BallSection cell(int i, int j, int k) const {
    BallSection section;
    for (int corner = 0; corner < 8; ++corner) {
      const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
      const double sign = (di + dj + dk) % 2 ? -1.0 : 1.0;
      const BallSection& part = at(i + di, j + dj, k + dk);
      section.volume += sign * part.volume;
      section.area += sign * part.area;
    }
    return section;
  }

 private:
  const BallSection& at(int i, int j, int k) const {
    const int row = (k - ranges_[2].first) * ranges_[1].nodes() + j - ranges_[1].first;
    return beyond_[row * ranges_[0].nodes() + i - ranges_[0].first];
  }

  std::array<Range, 3> ranges_;
  std::vector<BallSection> beyond_;
};

}  // namespace

SolidOverlaps solid_overlaps(const Spheres& spheres, const Grid& grid) {
  SolidOverlaps overlaps;
  overlaps.solid = Eigen::VectorXd::Zero(grid.size());
  for (int s = 0; s < spheres.size(); ++s) {
    const Eigen::Vector3d centre = spheres.centres.col(s);
    const double radius = spheres.radii[s];
    std::array<Range, 3> ranges;
    for (int axis = 0; axis < 3; ++axis)
      ranges[axis] = reach(centre[axis], radius, grid.lengths[axis], grid.counts[axis]);
    const Corners corners(centre, radius, grid, ranges);
    for (int k = ranges[2].first; k < ranges[2].last; ++k)
      for (int j = ranges[1].first; j < ranges[1].last; ++j)
        for (int i = ranges[0].first; i < ranges[0].last; ++i) {
          const BallSection part = corners.cell(i, j, k);
          if (part.volume <= 0.0) continue;  // a corner that the sphere does not reach, or rounding
          const int cell = grid.index({i, j, k});
          overlaps.cell.push_back(cell);
          overlaps.volume.push_back(part.volume);
          overlaps.solid[cell] += part.volume;
          overlaps.surface += part.area;
        }
    overlaps.begin.push_back(static_cast<int>(overlaps.cell.size()));
  }
  return overlaps;
}

}  // namespace pfv
