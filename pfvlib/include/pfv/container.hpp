// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/options.hpp"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace pfv {

/// The shape of a wall, in the coordinates of the packing.
struct Surface {
  enum class Kind {
    plane,    ///< the fluid is where normal . x <= offset
    cylinder  ///< round; the fluid is where x is nearer to the axis than the radius
  };
  Kind kind = Kind::plane;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< plane: outward unit normal
  double offset = 0.0;                                ///< plane: m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    ///< cylinder: unit vector along its axis
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< cylinder: a point of the axis, m
  double radius = 0.0;                                ///< cylinder: m

  /// The normal and the axis need not have length one.
  static Surface plane(const Eigen::Vector3d& outward_normal, const Eigen::Vector3d& through);
  static Surface cylinder(const Eigen::Vector3d& axis, const Eigen::Vector3d& point, double radius);

  bool is_plane() const { return kind == Kind::plane; }
  /// Distance of a place from the wall, m; positive on the fluid's side.
  double distance(const Eigen::Vector3d& place) const;
  /// Outward unit normal at the point nearest to a place.
  Eigen::Vector3d outward_at(const Eigen::Vector3d& place) const;
};

/// One wall of a container.
struct ContainerFace {
  std::string name;
  Surface surface;
  Wall wall = Wall::no_slip;
  Boundary boundary;
  // how it moves: as a rigid body. What a no-slip wall does in its own surface takes the fluid along.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the pivot, m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();             ///< m
  /// The way along which a piston on this face is guided; its force and velocity are positive along it. A
  /// unit vector; zero: none.
  Eigen::Vector3d guide = Eigen::Vector3d::Zero();
  /// Whether others may keep the fluid from it, as from the part of a drum that is above a free surface. If not, a face
  /// that bounds nothing is refused: mostly its normal points the wrong way.
  bool may_bound_nothing = false;
};

/// The part of a face, by its number, within a block of space, with a boundary of its own: it takes the pores of the face
/// that have the nearest point of it there, or if none does the one that is nearest to the block's middle. Where
/// patches overlap, the later one wins. A block may reach beyond its face; infinite bounds are none.
struct ContainerPatch {
  int face = 0;
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());  ///< m
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());   ///< m
  Boundary boundary;
};

/// What holds the fluid: a closed convex set of faces, planes at any angle and round cylinders with ends
/// square to their axis. A box is one of them, with its faces in the order xlo ... zhi.
///
/// A pore that touches several faces takes the first of: imposed pressure (the mean, where it touches several
/// with different ones), imposed flux (the first face in their order), sealed.
struct Container {
  std::vector<ContainerFace> faces;
  std::vector<ContainerPatch> patches;
  std::vector<Region> regions;
  /// Axes along which the packing repeats. Along each stand two planes normal to it, the ends of a period, which are
  /// no walls; all other faces are parallel to it. A cylinder may be periodic along its own axis.
  std::array<bool, 3> periodic{false, false, false};
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();     ///< of a periodic cell: xy, xz, yz, m
  Eigen::Vector3d pressure_gradient = Eigen::Vector3d::Zero();
  /// The smallest box around it, m; a flow finds it anew for the faces as they are.
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Ones();
  bool is_box = false;  ///< made from a Box

  Container() = default;
  Container(const Box& box);  // NOLINT: a box is a container

  int face_count() const { return static_cast<int>(faces.size()); }
  /// Number of the face of that name, if there is one.
  std::optional<int> face_named(const std::string& name) const;
  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
};

/// Most faces that a container may have.
inline constexpr int most_faces = 64;

/// Of these faces, with `lower` and `upper` filled in. Throws InputError as `check` does. Cost: faces².
Container container_of(std::vector<ContainerFace> faces);
/// Fills in `lower` and `upper`; a box keeps its own. Cost: faces².
void find_bounds(Container& container);
/// Copies them from a container whose faces have the same positions and shapes, at no such cost. Returns false and
/// changes nothing where these differ, or for a box.
bool take_bounds(Container& container, const Container& known);

/// On a face: within the block x0, x1, y0, y1, z0, z1, or, as `Patch`, a rectangle a0, a1, b0, b1 along the two other axes on
/// a plane that is normal to one (m). Throws InputError for other numbers of them, and a rectangle on another face.
ContainerPatch patch_on(const Container& container, int face, const std::vector<double>& bounds, const Boundary& boundary);

/// Volume (m³), area of each face (m²). Throws InputError for a container that is not closed.
double volume_of(const Container& container);
std::vector<double> face_areas(const Container& container);

/// The box that a container is, if it is one.
std::optional<Box> box_of(const Container& container);

/// Throws InputError when the container is open, empty or not convex, a face bounds nothing that may not, its name is
/// missing or occurs twice, its shape or motion is not finite, a cylinder's ends are not square to it, a periodic axis has
/// not two ends at rest or other faces that are not parallel to it, or as `check(Box)` does.
void check(const Container& container);
/// Throws InputError for options that need a box, or plane walls.
void check(const Container& container, const Options& options);

}  // namespace pfv
