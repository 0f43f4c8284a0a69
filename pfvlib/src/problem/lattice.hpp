// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace pfv {

/// The periods of a packing that repeats. Its vectors are (Lx, 0, 0), (xy, Ly, 0) and (xz, yz, Lz), so that the brick
/// of the edges Lx, Ly, Lz holds each grain once, also where the cell is tilted.
struct Lattice {
  using Shift = std::array<int, 3>;
  static constexpr Shift here{0, 0, 0};

  Eigen::Vector3d edges = Eigen::Vector3d::Ones();  ///< m
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();   ///< xy, xz, yz, m
  std::array<bool, 3> periodic{false, false, false};

  Eigen::Vector3d displacement(const Shift& shift) const {
    return Eigen::Vector3d(shift[0], shift[1], shift[2]).cwiseProduct(edges) +
           Eigen::Vector3d(shift[1] * tilt[0] + shift[2] * tilt[1], shift[2] * tilt[2], 0.0);
  }
  /// Whole periods in a place or a way, by a rule for each axis: std::floor, std::round.
  template <class Whole>
  Shift periods(Eigen::Vector3d way, Whole&& whole) const {
    Shift shift{0, 0, 0};
    for (int axis = 2; axis >= 0; --axis) {  // the last vector leans over the others
      if (!periodic[axis]) continue;
      shift[axis] = static_cast<int>(whole(way[axis] / edges[axis]));
      if (axis == 2) way[1] -= shift[2] * tilt[2];
      way[0] -= axis == 2 ? shift[2] * tilt[1] : axis == 1 ? shift[1] * tilt[0] : 0.0;
    }
    return shift;
  }
  /// Those that bring a way nearest to zero.
  Shift nearest(const Eigen::Vector3d& way) const {
    return periods(way, [](double x) { return std::round(x); });
  }
  /// All whose way, m, is between two bounds along each axis.
  std::vector<Shift> between(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    const auto range = [&](int axis, double leaning) {
      if (!periodic[axis]) return low[axis] <= 0.0 && high[axis] >= 0.0 ? std::pair(0, 0) : std::pair(1, 0);
      constexpr double slack = 1e-9;
      return std::pair(static_cast<int>(std::ceil((low[axis] - leaning) / edges[axis] - slack)),
                       static_cast<int>(std::floor((high[axis] - leaning) / edges[axis] + slack)));
    };
    std::vector<Shift> shifts;
    const auto [z0, z1] = range(2, 0.0);
    for (int z = z0; z <= z1; ++z) {
      const auto [y0, y1] = range(1, z * tilt[2]);
      for (int y = y0; y <= y1; ++y) {
        const auto [x0, x1] = range(0, y * tilt[0] + z * tilt[1]);
        for (int x = x0; x <= x1; ++x) shifts.push_back({x, y, z});
      }
    }
    return shifts;
  }
};

}  // namespace pfv
