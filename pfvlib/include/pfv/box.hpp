// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/names.hpp"

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace pfv {

/// The six faces of the flow box. Even numbers are the lower faces; number / 2 is the axis.
enum class Face { xlo, xhi, ylo, yhi, zlo, zhi };
inline constexpr std::array<Face, 6> all_faces{Face::xlo, Face::xhi, Face::ylo,
                                               Face::yhi, Face::zlo, Face::zhi};
inline constexpr int face_count = static_cast<int>(all_faces.size());

inline int axis_of(Face face) { return static_cast<int>(face) / 2; }
inline bool is_upper(Face face) { return static_cast<int>(face) % 2 == 1; }
/// Outward unit normal of a face.
inline Eigen::Vector3d outward_normal(Face face) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[axis_of(face)] = is_upper(face) ? 1.0 : -1.0;
  return normal;
}
template <>
struct Names<Face> {
  static constexpr const char* what = "face";
  static constexpr std::array<Named<Face>, 6> all{{{Face::xlo, "xlo"},
                                                   {Face::xhi, "xhi"},
                                                   {Face::ylo, "ylo"},
                                                   {Face::yhi, "yhi"},
                                                   {Face::zlo, "zlo"},
                                                   {Face::zhi, "zhi"}}};
};

/// How fluid slides along a sealed face. A face that fluid crosses (pressure or flux) is fluid, not
/// wall: its type is ignored.
enum class Wall { no_slip, symmetry };
template <>
struct Names<Wall> {
  static constexpr const char* what = "wall";
  static constexpr std::array<Named<Wall>, 2> all{{{Wall::no_slip, "no_slip"}, {Wall::symmetry, "symmetry"}}};
};

/// What the fluid meets at a face or patch.
struct Boundary {
  enum class Kind {
    sealed,    ///< nothing crosses it
    pressure,  ///< every pore on it carries `value` (Pa), or `profile(place, time)` if that is set
    flux       ///< `value` m³/s cross it INTO the box; its pores share one unknown pressure
  };
  Kind kind = Kind::sealed;
  double value = 0.0;
  /// Imposed pressure (Pa) as a function of the pore's place (m) and of the flow time (s).
  std::function<double(const Eigen::Vector3d&, double)> profile;

  /// Pores on it have a pressure that is given.
  bool imposes_pressure() const { return kind == Kind::pressure; }
  /// A flow rate that is given enters through it.
  bool imposes_flux() const { return kind == Kind::flux; }
  bool drives_flux() const { return imposes_flux() && value != 0.0; }
  /// Fluid may cross it.
  bool is_open() const { return kind != Kind::sealed; }

  static Boundary sealed() { return {}; }
  static Boundary pressure(double pascal) { return {Kind::pressure, pascal, {}}; }
  static Boundary flux(double cubic_metres_per_second) {
    return {Kind::flux, cubic_metres_per_second, {}};
  }
};

/// How each kind is written, the letter and the unit of its value (null for one without), and what help says of it.
struct BoundaryKind {
  Boundary::Kind kind;
  const char* name;
  const char* symbol;
  const char* unit;
  const char* note;

  bool is_open() const { return Boundary{kind, 0.0, {}}.is_open(); }
};
inline constexpr std::array<BoundaryKind, 3> boundary_kinds{
    {{Boundary::Kind::sealed, "sealed", nullptr, nullptr, "no fluid crosses it"},
     {Boundary::Kind::pressure, "pressure", "P", "Pa", "of each pore on it"},
     {Boundary::Kind::flux, "flux", "Q", "m3/s", "positive into the box"}}};

/// The kinds in their order, each as `form` writes it, for help and messages; one without a text is left out.
std::string list_boundary_kinds(const std::function<std::string(const BoundaryKind&)>& form,
                                const char* separator = ", ");
/// "sealed, pressure, flux"
std::string names_of_boundaries();

/// One of the six plane walls of the box.
struct FaceCondition {
  Wall wall = Wall::no_slip;
  Boundary boundary;
  double velocity = 0.0;  ///< m/s along the face's axis, positive along +axis
  // in its own plane: a no-slip wall takes the fluid beside it along; nothing else feels it
  Eigen::Vector3d sliding = Eigen::Vector3d::Zero();  ///< m/s, 0 along the axis
  double spin = 0.0;                                  ///< rad/s about +axis, by the right-hand rule
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();    ///< a point that the spin leaves in place, m
};

/// A rectangle on a face with a boundary of its own, for instance an outlet. It takes the pores whose
/// centre lies in it (borders included) or, where there is none, the pore of the face nearest to its
/// middle. Where patches overlap, the later one wins.
struct Patch {
  Face face = Face::zhi;
  /// a0, a1, b0, b1 (m): extent along the two other axes, in the order x, y, z.
  std::array<double, 4> rectangle{};
  Boundary boundary;
};

/// A part of the packing with a pressure or a flux of its own, for instance a well: the pores whose
/// centre lies between `lower` and `upper` (borders included) or, where there is none, the pore whose
/// centre is nearest to the middle, so that lower = upper gives a point. Such a pore belongs to the
/// region alone, also where it touches a face; where regions overlap, the later one wins. The fluid
/// that a flux brings in appears at rest: it exerts no force of its own.
struct Region {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();  ///< m
  Boundary boundary;  ///< pressure or flux
};

/// The flow box: six plane walls normal to the axes, m.
///
/// A pore that touches several faces takes the first of: imposed pressure (the mean, where it touches
/// two faces with different ones), imposed flux (the first face in the order xlo ... zhi), sealed.
struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Ones();
  std::array<FaceCondition, 6> faces;
  std::vector<Patch> patches;
  std::vector<Region> regions;
  /// Axes along which the packing repeats; their two faces do not exist (they stay sealed). A difference of
  /// their velocities stretches the cell: an image n lengths L away moves by n dL/dt beside its sphere, and a
  /// sphere has the velocity that belongs to where the packing has it.
  std::array<bool, 3> periodic{false, false, false};
  /// How far a tilted cell leans, m: xy, the way of its upper y side along x, then xz and yz. The packing repeats
  /// by (Lx, 0, 0), (xy, Ly, 0) and (xz, yz, Lz); both axes of a component must be periodic.
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();
  /// Macroscopic pressure gradient along the periodic axes, Pa/m: the pressure is a periodic field plus
  /// gradient . x, and fluid flows against it.
  Eigen::Vector3d pressure_gradient = Eigen::Vector3d::Zero();

  FaceCondition& operator[](Face face) { return faces[static_cast<int>(face)]; }
  const FaceCondition& operator[](Face face) const { return faces[static_cast<int>(face)]; }
  double position(Face face) const {
    return is_upper(face) ? upper[axis_of(face)] : lower[axis_of(face)];
  }
  /// Area of a face, m².
  double area(Face face) const {
    const Eigen::Vector3d edge = upper - lower;
    const int axis = axis_of(face);
    return edge[(axis + 1) % 3] * edge[(axis + 2) % 3];
  }
  double volume() const { return (upper - lower).prod(); }
  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  bool is_tilted() const { return !tilt.isZero(0.0); }
};

/// Throws InputError, which begins with `where`, for a value that is not finite.
void check(const Boundary& boundary, const std::string& where);
/// Throws InputError when the box is flat, inverted or not finite, or when a boundary value, a face
/// velocity, a patch or a region is not finite, inverted or outside its face or the box.
void check(const Box& box);

}  // namespace pfv
