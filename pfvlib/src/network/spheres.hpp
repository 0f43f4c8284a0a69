// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/network.hpp"
#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>

namespace pfv {

/// The spheres inside a box, in coordinates that start at its lower corner (so that a box far from
/// the origin loses no digits), with the lengths of the box's edges, m.
struct Spheres {
  Packing::Ids ids;
  Eigen::Matrix3Xd centres;
  Eigen::VectorXd radii;
  Eigen::Vector3d edges;
  std::array<bool, 3> periodic{false, false, false};

  int size() const { return static_cast<int>(radii.size()); }
  /// Distance from sphere k to wall `face`, m.
  double distance(int k, int face) const {
    const int axis = face / 2;
    return face % 2 ? edges[axis] - centres(axis, k) : centres(axis, k);
  }
  /// From sphere k towards a vertex: the difference of centres, or the wall's outward unit normal.
  Eigen::Vector3d towards(int k, Vertex vertex) const {
    if (is_wall(vertex)) return outward_normal(static_cast<Face>(wall_number(vertex)));
    return centres.col(vertex) - centres.col(k);
  }
};

/// "sphere 12", "spheres 12, 40 and 7 more": for messages.
std::string sphere_list(const Packing::Ids& ids, const std::vector<int>& columns);

}  // namespace pfv
