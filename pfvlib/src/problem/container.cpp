// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/container.hpp"

#include "pfv/error.hpp"
#include "problem/box_changes.hpp"
#include "problem/container_geometry.hpp"
#include "problem/wall_polygons.hpp"
#include "text/number_text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
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

/// The two other axes, in the order x, y, z.
std::array<int, 2> axes_beside(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

ContainerPatch rectangle_on(int face, int axis, const std::array<double, 4>& rectangle, const Boundary& boundary) {
  ContainerPatch patch;
  patch.face = face;
  patch.boundary = boundary;
  const auto [a, b] = axes_beside(axis);
  patch.lower[a] = rectangle[0];
  patch.upper[a] = rectangle[1];
  patch.lower[b] = rectangle[2];
  patch.upper[b] = rectangle[3];
  return patch;
}

Patch on_box(const ContainerPatch& patch) {
  const auto face = static_cast<Face>(patch.face);
  const auto [a, b] = axes_beside(axis_of(face));
  return {face, {patch.lower[a], patch.upper[a], patch.lower[b], patch.upper[b]}, patch.boundary};
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
                       " are both cylinders; one holds the fluid: what stands inside, as the inner cylinder of an annulus, is an "
                       "obstacle of a mesh (--obstacle FILE.stl; fix: obstacle mesh ID)");
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

/// Of a strip its width: twice the area over the length around it, m.
double width_of(const std::vector<Eigen::Vector3d>& polygon, double area) {
  double around = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) around += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  return 2.0 * area / around;
}

/// Of the container's size: between the edges of a narrower face the triangulation sees rounding alone.
constexpr double least_width = 1e-8;

void refuse_idle_faces(const Container& container) {
  const ContainerGeometry geometry = geometry_of(container, container.lower);
  const double size = (container.upper - container.lower).norm();
  for (int f = 0; f < container.face_count(); ++f) {
    if (container.faces[f].may_bound_nothing) continue;
    const std::string name = "container: face " + container.faces[f].name;
    if (!(geometry.areas[f] > 0.0))
      throw InputError(name + " bounds nothing, since others keep the fluid from it; remove it, or turn its normal");
    if (geometry.polygons.empty() || geometry.polygons[f].empty()) continue;
    const double width = width_of(geometry.polygons[f], geometry.areas[f]);
    if (width < least_width * size)
      throw InputError(name + " is a strip " + detail::number_text(width) + " m wide between others, which is rounding to a "
                       "container of " + detail::number_text(size) + " m; leave it out");
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

void check_periodic_face(const Container& container, int f, int axis) {
  const ContainerFace& face = container.faces[f];
  const Surface& surface = face.surface;
  const bool parallel = surface.is_plane() ? surface.normal[axis] == 0.0 : std::abs(surface.axis[axis]) == 1.0;
  const std::string along = std::string(1, "xyz"[axis]);
  if (periodic_axis(container, f) != axis && !parallel)
    throw InputError("container: face " + face.name + " is neither normal nor parallel to " + along +
                     ", which is periodic; give it walls in place of the period");
  if (periodic_axis(container, f) == axis &&
      (face.boundary.is_open() || !face.velocity.isZero(0.0) || !face.angular_velocity.isZero(0.0)))
    throw InputError("container: face " + face.name + " is an end of the period along " + along +
                     ": it can have neither a boundary nor a motion");
}

/// Two ends at rest along each periodic axis, and nothing that goes across.
void check_periodic(const Container& container) {
  if (!container.tilt.isZero(0.0)) throw InputError("container: a tilt needs a box");
  for (int axis = 0; axis < 3; ++axis) {
    const std::string along = std::string(1, "xyz"[axis]);
    const double gradient = container.pressure_gradient[axis];
    if (!std::isfinite(gradient) || (gradient != 0.0 && !container.periodic[axis]))
      throw InputError("container: the pressure gradient along " + along +
                       " is no finite number, or that axis is not periodic; give its faces pressures");
    if (!container.periodic[axis]) continue;
    int ends = 0;
    for (int f = 0; f < container.face_count(); ++f) {
      check_periodic_face(container, f, axis);
      ends += periodic_axis(container, f) == axis;
    }
    if (ends != 2)
      throw InputError("container: along " + along + ", which is periodic, it has " + std::to_string(ends) +
                       " planes normal to that axis; give it two, a period apart");
  }
  for (const ContainerPatch& patch : container.patches)
    if (patch.face >= 0 && patch.face < container.face_count() && periodic_axis(container, patch.face) >= 0)
      throw InputError("container: a patch on face " + container.faces[patch.face].name +
                       ", which is an end of a period and no wall; remove it");
}

/// Whether the block reaches the face, of which these are polygons.
bool reaches(const ContainerPatch& patch, const std::vector<WallPolygon>& polygons, double slack) {
  return std::any_of(polygons.begin(), polygons.end(), [&](const WallPolygon& polygon) {
    if (polygon.face != patch.face) return false;
    Polygon3 left = polygon.corners;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
      if (std::isfinite(patch.upper[axis])) left = clip(left, Surface::plane(along, (patch.upper[axis] + slack) * along));
      if (std::isfinite(patch.lower[axis])) left = clip(left, Surface::plane(-along, (patch.lower[axis] - slack) * along));
    }
    return !left.empty();
  });
}

void check_patches(const Container& container) {
  if (container.patches.empty()) return;
  const std::vector<WallPolygon> polygons = wall_polygons(container);
  // a cylinder's strips lie as much within it
  const std::optional<int> round = cylinder_of(container);
  const double slack = round ? 1e-3 * container.faces[*round].surface.radius
                             : 1e-9 * (container.upper - container.lower).norm();
  for (std::size_t i = 0; i < container.patches.size(); ++i) {
    const ContainerPatch& patch = container.patches[i];
    const std::string where = "patch " + std::to_string(i + 1);
    if (patch.face < 0 || patch.face >= container.face_count())
      throw InputError(where + ": there is no face " + std::to_string(patch.face));
    const std::string on_face = where + " on face " + container.faces[patch.face].name;
    if (!(patch.lower.array() < patch.upper.array()).all())
      throw InputError(on_face + ": its block is flat, inverted or no number; give each lower bound first");
    if (!reaches(patch, polygons, slack))
      throw InputError(on_face + ": its block does not reach the face; move it there");
    check(patch.boundary, on_face);
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
    patches.push_back(rectangle_on(static_cast<int>(patch.face), axis_of(patch.face), patch.rectangle, patch.boundary));
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
  refuse_idle_faces(container);
  return container;
}

ContainerPatch patch_on(const Container& container, int face, const std::vector<double>& bounds, const Boundary& boundary) {
  const std::string where = "patch on face " + container.faces.at(face).name;
  const Surface& surface = container.faces[face].surface;
  if (bounds.size() == 4) {
    Eigen::Index axis = 0;
    if (!surface.is_plane() || !(surface.normal.cwiseAbs().maxCoeff(&axis) > 1.0 - square))
      throw InputError(where + ": a rectangle needs a plane normal to an axis; give the block of space that cuts the part out of "
                       "the face, x0, x1, y0, y1, z0, z1");
    return rectangle_on(face, static_cast<int>(axis), {bounds[0], bounds[1], bounds[2], bounds[3]}, boundary);
  }
  if (bounds.size() != 6)
    throw InputError(where + ": give the four numbers of a rectangle on it, or the six of a block of space");
  return {face, {bounds[0], bounds[2], bounds[4]}, {bounds[1], bounds[3], bounds[5]}, boundary};
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
    box.patches.push_back(on_box(patch));
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
  refuse_idle_faces(container);
}

void check_conditions(const Container& container) {
  check_shapes(container);
  for (const ContainerFace& face : container.faces) check(face.boundary, "face " + face.name);
  check_periodic(container);
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
