// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"
#include "pfv/network.hpp"
#include "pfv/packing.hpp"
#include "problem/lattice.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace pfv {

/// A wall in the coordinates of the spheres.
struct WallSurface {
  Surface surface;
  int axis = -1;            ///< of a plane normal to an axis: that axis
  bool upper = false;       ///< ... and its side
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::Zero();  ///< square to a cylinder's axis

  bool is_plane() const { return surface.is_plane(); }
  /// Place in a cylinder's section, and height along its axis, m.
  Eigen::Vector2d in_section(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d from = place - surface.point;
    return {first.dot(from), second.dot(from)};
  }
  double height(const Eigen::Vector3d& place) const { return surface.axis.dot(place - surface.point); }
};

/// The spheres inside a container, in coordinates that start at the lower corner of the box around it (so that
/// a container far from the origin loses no digits), with its walls and the lengths of that box's edges, m.
struct Spheres {
  Packing::Ids ids;
  Eigen::Matrix3Xd centres;
  Eigen::VectorXd radii;
  Eigen::Vector3d edges;
  std::vector<WallSurface> walls;
  double volume = 0.0;  ///< of the container, m³
  double mean_radius = 0.0;  ///< of all spheres in it, those that other ranks have too, m
  Eigen::VectorXd displaced;  ///< m³ of fluid that each takes the place of; empty: whole spheres
  std::array<bool, 3> periodic{false, false, false};
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< of a periodic cell, m
  double spread = 0.0;  ///< of images: largest extent of those that one rank would have, m; 0: that of these

  Lattice lattice() const { return {edges, tilt, periodic}; }
  int size() const { return static_cast<int>(radii.size()); }
  int wall_count() const { return static_cast<int>(walls.size()); }
  const WallSurface& wall(Vertex vertex) const { return walls[wall_number(vertex)]; }
  /// Distance from sphere k to a wall, m.
  double distance(int k, int wall) const {
    const WallSurface& w = walls[wall];
    if (w.axis >= 0) return w.upper ? w.surface.offset - centres(w.axis, k) : w.surface.offset + centres(w.axis, k);
    if (w.is_plane()) return w.surface.offset - w.surface.normal.dot(centres.col(k));
    return w.surface.radius - w.in_section(centres.col(k)).norm();
  }
  /// Outward unit normal of a wall at its point nearest to sphere k.
  Eigen::Vector3d outward(int k, Vertex vertex) const {
    const WallSurface& w = wall(vertex);
    if (w.is_plane()) return w.surface.normal;
    const Eigen::Vector2d place = w.in_section(centres.col(k));
    const double length = place.norm();
    if (!(length > 0.0)) return w.first;  // on the axis each way is as good
    return (place.x() * w.first + place.y() * w.second) / length;
  }
  /// From sphere k towards a vertex: the difference of centres, or the wall's outward unit normal.
  Eigen::Vector3d towards(int k, Vertex vertex) const {
    if (is_wall(vertex)) return outward(k, vertex);
    return centres.col(vertex) - centres.col(k);
  }
};

/// The walls of a container in coordinates that start at `origin`.
std::vector<WallSurface> walls_of(const Container& container, const Eigen::Vector3d& origin);

/// "sphere 12", "spheres 12, 40 and 7 more": for messages.
std::string sphere_list(const Packing::Ids& ids, const std::vector<int>& columns);

}  // namespace pfv
