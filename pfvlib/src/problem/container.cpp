// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/container.hpp"

#include "pfv/error.hpp"
#include "pfv/idle_faces.hpp"
#include "problem/box_changes.hpp"
#include "problem/container_geometry.hpp"
#include "text/number_text.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <set>

namespace pfv {

namespace {

constexpr double square = 1e-9;  // cosine below which directions are square to each other

ContainerFace face_of(const Box& box, Face face) {
  const FaceCondition& from = box[face];
  ContainerFace result;
  result.name = name_of(face);
  result.surface.normal = outward_normal(face);
  result.surface.offset = is_upper(face) ? box.position(face) : -box.position(face);
  result.wall = from.wall;
  result.boundary = from.boundary;
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis_of(face));
  result.velocity = from.velocity * along + from.sliding;
  result.angular_velocity = from.spin * along;
  result.pivot = from.pivot;
  result.guide = along;
  return result;
}

void require_finite(const ContainerFace& face, const std::string& where) {
  const Surface& s = face.surface;
  const bool finite = s.normal.allFinite() && std::isfinite(s.offset) && s.axis.allFinite() &&
                      s.point.allFinite() && std::isfinite(s.radius) && face.velocity.allFinite() &&
                      face.angular_velocity.allFinite() && face.pivot.allFinite() &&
                      face.guide.allFinite();
  if (!finite) throw InputError(where + ": its shape or motion has a number that is not finite");
  const double length = (s.is_plane() ? s.normal : s.axis).norm();
  if (!(std::abs(length - 1.0) < 1e-12))
    throw InputError(where + ": its direction has length " + detail::number_text(length) +
                     ", not 1: make it with Surface::plane or Surface::cylinder");
  if (!s.is_plane() && !(s.radius > 0.0))
    throw InputError(where + ": its radius " + detail::number_text(s.radius) + " m is not a positive number");
}

void check_names(const Container& container) {
  std::set<std::string> names;
  for (const ContainerFace& face : container.faces) {
    if (face.name.empty()) throw InputError("container: a face has no name; give each one");
    if (!names.insert(face.name).second)
      throw InputError("container: the name " + face.name + " occurs twice; give each face its own");
  }
}

/// A cylinder has two ends square to its axis, and no other wall.
void check_cylinder(const Container& container, int cylinder) {
  const Eigen::Vector3d& axis = container.faces[cylinder].surface.axis;
  const std::string& name = container.faces[cylinder].name;
  int lower = 0, upper = 0;
  for (int f = 0; f < container.face_count(); ++f) {
    if (f == cylinder) continue;
    const ContainerFace& face = container.faces[f];
    if (!face.surface.is_plane())
      throw InputError("container: faces " + name + " and " + face.name +
                       " are both cylinders; one is supported: take planes for the other, or spheres on "
                       "its surface");
    const double along = face.surface.normal.dot(axis);
    if (!(face.surface.normal.cross(axis).norm() < square))
      throw InputError("container: plane " + face.name + " is not square to the axis of cylinder " + name +
                       ", which is not supported: take planes around it instead of the cylinder");
    ++(along > 0.0 ? upper : lower);
  }
  if (lower != 1 || upper != 1)
    throw InputError("container: cylinder " + name + " has " + std::to_string(lower + upper) +
                     " planes across it; give it one at each end");
}

/// Two faces on one plane would both count for what one of them bounds.
void require_different_planes(const Container& container) {
  for (int f = 0; f < container.face_count(); ++f)
    for (int other = 0; other < f; ++other) {
      const Surface &a = container.faces[f].surface, &b = container.faces[other].surface;
      if (!a.is_plane() || !b.is_plane() || a.normal.dot(b.normal) < 0.0) continue;
      const double apart = std::abs(a.offset - b.offset);
      if (a.normal.cross(b.normal).norm() > square || apart > square * (container.upper - container.lower).norm())
        continue;
      throw InputError("container: faces " + container.faces[other].name + " and " + container.faces[f].name +
                       " are the same plane; leave one of them out");
    }
}

/// Of all faces together, their motion aside.
void check_shapes(const Container& container) {
  if (container.face_count() < 3 || container.face_count() > most_faces)
    throw InputError("container: it has " + std::to_string(container.face_count()) +
                     " faces; 3 to " + std::to_string(most_faces) +
                     " are possible (take fewer planes around an axis, as 32, or for a dense bed a cylinder)");
  check_names(container);
  for (const ContainerFace& face : container.faces) require_finite(face, "face " + face.name);
  if (const std::optional<int> cylinder = cylinder_of(container)) check_cylinder(container, *cylinder);
}

void check_patches(const Container& container) {
  for (std::size_t i = 0; i < container.patches.size(); ++i) {
    const int f = container.patches[i].face;
    const std::string where = "patch " + std::to_string(i + 1);
    if (f < 0 || f >= container.face_count())
      throw InputError(where + ": there is no face " + std::to_string(f));
    const Surface& surface = container.faces[f].surface;
    if (!surface.is_plane() || !(surface.normal.cwiseAbs().maxCoeff() > 1.0 - square))
      throw InputError(where + " on face " + container.faces[f].name +
                       ": a rectangle needs a plane normal to an axis; take a region instead");
  }
}

/// What a box and a container have in common is checked on the box around the container.
Box box_around(const Container& container) {
  Box box;
  box.lower = container.lower;
  box.upper = container.upper;
  box.regions = container.regions;
  return box;
}

}  // namespace

Surface Surface::plane(const Eigen::Vector3d& outward_normal, const Eigen::Vector3d& through) {
  Surface surface;
  surface.normal = outward_normal.normalized();
  surface.offset = surface.normal.dot(through);
  return surface;
}

Surface Surface::cylinder(const Eigen::Vector3d& axis, const Eigen::Vector3d& point, double radius) {
  Surface surface;
  surface.kind = Kind::cylinder;
  surface.axis = axis.normalized();
  surface.point = point;
  surface.radius = radius;
  return surface;
}

double Surface::distance(const Eigen::Vector3d& place) const {
  if (is_plane()) return offset - normal.dot(place);
  const Eigen::Vector3d from = place - point;
  return radius - (from - axis.dot(from) * axis).norm();
}

Eigen::Vector3d Surface::outward_at(const Eigen::Vector3d& place) const {
  if (is_plane()) return normal;
  const Eigen::Vector3d from = place - point;
  const Eigen::Vector3d out = from - axis.dot(from) * axis;
  return out.norm() > 0.0 ? Eigen::Vector3d(out.normalized()) : axis.unitOrthogonal();
}

Container::Container(const Box& box)
    : regions(box.regions),
      periodic(box.periodic),
      tilt(box.tilt),
      pressure_gradient(box.pressure_gradient),
      lower(box.lower),
      upper(box.upper),
      is_box(true) {
  for (const Face face : all_faces) faces.push_back(face_of(box, face));
  for (const Patch& patch : box.patches)
    patches.push_back({static_cast<int>(patch.face), patch.rectangle, patch.boundary});
}

std::optional<int> Container::face_named(const std::string& name) const {
  for (int f = 0; f < face_count(); ++f)
    if (faces[f].name == name) return f;
  return {};
}

Container container_of(std::vector<ContainerFace> faces) {
  Container container;
  container.faces = std::move(faces);
  check_shapes(container);
  find_bounds(container);
  return container;
}

std::optional<Box> box_of(const Container& container) {
  if (!container.is_box) return {};
  Box box;
  box.lower = container.lower;
  box.upper = container.upper;
  for (const Face face : all_faces) {
    const ContainerFace& from = container.faces[static_cast<int>(face)];
    const int axis = axis_of(face);
    FaceCondition& to = box[face];
    to = {from.wall, from.boundary, from.velocity[axis], from.velocity, from.angular_velocity[axis],
          from.pivot};
    to.sliding[axis] = 0.0;
  }
  for (const ContainerPatch& patch : container.patches)
    box.patches.push_back({static_cast<Face>(patch.face), patch.rectangle, patch.boundary});
  box.regions = container.regions;
  box.periodic = container.periodic;
  box.tilt = container.tilt;
  box.pressure_gradient = container.pressure_gradient;
  return box;
}

bool take_bounds(Container& container, const Container& known) {
  if (container.is_box || known.is_box || !same_surfaces(container, known)) return false;
  container.lower = known.lower;
  container.upper = known.upper;
  return true;
}

void check(const Container& container) {
  if (const std::optional<Box> box = box_of(container)) {
    check(*box);
    return;
  }
  check_conditions(container);
  require_different_planes(container);
}

void refuse_idle_faces(const Container& container, const std::vector<char>& may) {
  const std::vector<double> areas = face_areas(container);
  for (int f = 0; f < container.face_count(); ++f)
    if (!(areas[f] > 0.0) && (may.empty() || !may[f]))
      throw InputError("container: face " + container.faces[f].name +
                       " bounds nothing, since others keep the fluid from it; remove it, or turn its normal");
}

void check_conditions(const Container& container) {
  check_shapes(container);
  for (const ContainerFace& face : container.faces) check(face.boundary, "face " + face.name);
  if (container.any_periodic() || !container.pressure_gradient.isZero(0.0))
    throw InputError("container: periodic axes and a pressure gradient need a box");
  check_patches(container);
  check(box_around(container));
}

void check(const Container& container, const Options& options) {
  if (options.partition == Partition::yade && !container.is_box)
    throw InputError("`partition yade` goes with a box alone: take the partition pfv in a container");
  const std::optional<int> cylinder = cylinder_of(container);
  if (!cylinder) return;
  const std::string of = " in a container with a cylinder (" + container.faces[*cylinder].name + ")";
  if (options.volume_rates == VolumeRates::geometric)
    throw InputError("there are no `volume_rates geometric`" + of + ": take `volume_rates reciprocal`, the default");
  if (options.torques)
    throw InputError("there are no `torques yes`" + of + ": leave them away, or take planes in its place");
}

}  // namespace pfv
