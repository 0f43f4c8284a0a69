// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/container_geometry.hpp"

#include "geometry/pi.hpp"
#include "pfv/error.hpp"
#include "problem/wall_polygons.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;

/// A square on a plane, counterclockwise about its normal.
Polygon3 square_on(const Surface& plane, const Vector& middle, double half) {
  const Vector foot = middle + (plane.offset - plane.normal.dot(middle)) * plane.normal;
  const Vector u = half * plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  return {foot + u + v, foot - u + v, foot - u - v, foot + u - v};
}

/// A polygon on a plane, with the plane that each side lies on, or -1: side i goes on from corner i.
struct CutPolygon {
  Polygon3 corners;
  std::vector<int> sides;
};

/// The part on the fluid's side of plane `number`.
CutPolygon cut(const CutPolygon& polygon, const Surface& plane, int number) {
  CutPolygon result;
  const auto add = [&](const Vector& corner, int side) {
    result.corners.push_back(corner);
    result.sides.push_back(side);
  };
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const Vector &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.corners.size()];
    const double da = plane.distance(a), db = plane.distance(b);
    if (da >= 0.0) add(a, da == 0.0 && db < 0.0 ? number : polygon.sides[i]);
    if (da > 0.0 && db < 0.0) add(a + da / (da - db) * (b - a), number);
    if (da < 0.0 && db > 0.0) add(a + da / (da - db) * (b - a), polygon.sides[i]);
  }
  return result;
}

/// Where three planes meet, the same for the faces of all three: only so do the areas of faces that are nearly parallel
/// add up to nothing.
void share_corners(CutPolygon& polygon, int face, const std::vector<Surface>& planes, double width) {
  constexpr double rounding = 1e-6;
  const std::size_t count = polygon.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::array<int, 3> meeting{face, polygon.sides[i], polygon.sides[(i + count - 1) % count]};
    std::sort(meeting.begin(), meeting.end());
    if (meeting[0] < 0 || meeting[0] == meeting[1] || meeting[1] == meeting[2]) continue;
    const Vector corner = corner_of_planes(planes[meeting[0]], planes[meeting[1]], planes[meeting[2]]);
    if ((corner - polygon.corners[i]).norm() < rounding * width) polygon.corners[i] = corner;
  }
}

/// The polygons that a square of the given half width leaves on each plane.
std::vector<Polygon3> clipped(const std::vector<Surface>& planes, const Vector& middle, double half) {
  std::vector<Polygon3> polygons;
  const int count = static_cast<int>(planes.size());
  for (int f = 0; f < count; ++f) {
    CutPolygon polygon{square_on(planes[f], middle, half), {-1, -1, -1, -1}};
    for (int other = 0; other < count && !polygon.corners.empty(); ++other)
      if (other != f) polygon = cut(polygon, planes[other], other);
    share_corners(polygon, f, planes, half);
    polygons.push_back(std::move(polygon.corners));
  }
  return polygons;
}

struct Extent {
  Vector lower, upper;
  bool empty = true;
};

Extent extent_of(const std::vector<Polygon3>& polygons) {
  Extent extent;
  for (const Polygon3& polygon : polygons)
    for (const Vector& corner : polygon) {
      extent.lower = extent.empty ? corner : Vector(extent.lower.cwiseMin(corner));
      extent.upper = extent.empty ? corner : Vector(extent.upper.cwiseMax(corner));
      extent.empty = false;
    }
  return extent;
}

/// The point with the least sum of squared distances from all planes: in the middle of a closed set of them.
Vector middle_of(const std::vector<Surface>& planes) {
  Eigen::MatrixX3d normals(planes.size(), 3);
  Eigen::VectorXd offsets(planes.size());
  for (std::size_t f = 0; f < planes.size(); ++f) {
    normals.row(static_cast<Eigen::Index>(f)) = planes[f].normal.transpose();
    offsets[static_cast<Eigen::Index>(f)] = planes[f].offset;
  }
  return normals.colPivHouseholderQr().solve(offsets);
}

/// Corners of the faces of the polyhedron within these planes. A first, wide square finds where it is, a second
/// one its corners to the last digits.
std::vector<Polygon3> polygons_of(const std::vector<Surface>& planes) {
  constexpr double wide = 1e5;
  const Vector middle = middle_of(planes);
  double size = 0.0;
  for (const Surface& plane : planes) size = std::max(size, std::abs(plane.distance(middle)));
  const Extent rough = extent_of(clipped(planes, middle, wide * size));
  if (rough.empty || !(size > 0.0))
    throw InputError("container: its planes leave no room between them; an inward normal points to the "
                     "fluid: turn the planes that look the other way");
  const double width = (rough.upper - rough.lower).maxCoeff();
  if (!(width < 0.5 * wide * size))
    throw InputError("container: it is open, since its planes do not close it on all sides; add the "
                     "planes that are missing");
  return clipped(planes, 0.5 * (rough.lower + rough.upper), 2.0 * width);
}

ContainerGeometry geometry_of_polyhedron(const Container& container, const Vector& origin) {
  std::vector<Surface> planes;
  for (const ContainerFace& face : container.faces) planes.push_back(face.surface);
  ContainerGeometry geometry;
  geometry.polygons = polygons_of(planes);
  geometry.loads.setZero(6, container.face_count());
  for (int f = 0; f < container.face_count(); ++f) {
    const Polygon3& polygon = geometry.polygons[f];
    double area = 0.0;
    Vector moment = Vector::Zero();  // of the area
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const double part =
          0.5 * (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]).dot(planes[f].normal);
      area += part;
      moment += part / 3.0 * (polygon[0] + polygon[i] + polygon[i + 1] - 3.0 * origin);
    }
    geometry.areas.push_back(area);
    geometry.loads.col(f) << area * planes[f].normal, moment.cross(planes[f].normal);
    if (!polygon.empty()) geometry.volume += moment.dot(planes[f].normal) / 3.0;
  }
  return geometry;
}

/// `lower`, `edges`: of the box, which may have moved on.
ContainerGeometry geometry_of_box(const Container& container, const Vector& lower, const Vector& edges,
                                  const Vector& origin) {
  ContainerGeometry geometry;
  geometry.volume = edges.prod();
  geometry.loads.setZero(6, container.face_count());
  const Vector middle = lower + 0.5 * edges - origin;
  for (int f = 0; f < container.face_count(); ++f) {
    const int axis = f / 2;
    const double area = edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
    const Vector& normal = container.faces[f].surface.normal;
    geometry.areas.push_back(area);
    geometry.loads.col(f) << area * normal, area * middle.cross(normal);
  }
  return geometry;
}

ContainerGeometry geometry_of_cylinder(const Container& container, const Vector& origin) {
  const Surface& shell = container.faces[*cylinder_of(container)].surface;
  ContainerGeometry geometry;
  geometry.loads.setZero(6, container.face_count());
  const auto ends = ends_of_cylinder(container);
  const double length = container.faces[ends[0]].surface.distance(shell.point) +
                        container.faces[ends[1]].surface.distance(shell.point);
  if (!(length > 0.0))
    throw InputError("container: the ends of its cylinder leave no room between them");
  const double section = pi * shell.radius * shell.radius;
  geometry.volume = section * length;
  for (int f = 0; f < container.face_count(); ++f) {
    const Surface& surface = container.faces[f].surface;
    geometry.areas.push_back(surface.is_plane() ? section : 2.0 * pi * shell.radius * length);
    if (!surface.is_plane()) continue;  // the shell's own pushes cancel
    const Vector centre = shell.point + surface.distance(shell.point) * surface.normal - origin;
    geometry.loads.col(f) << section * surface.normal, section * centre.cross(surface.normal);
  }
  return geometry;
}

/// Where a face's shape is after some time of its motion.
Surface surface_after(const ContainerFace& face, double time) {
  const double angle = time * face.angular_velocity.norm();
  Eigen::AngleAxisd turn = Eigen::AngleAxisd::Identity();
  if (angle != 0.0) turn = Eigen::AngleAxisd(angle, (angle / time > 0.0 ? 1.0 : -1.0) * face.angular_velocity.normalized());
  const auto moved = [&](const Vector& place) -> Vector {
    return face.pivot + turn * (place - face.pivot) + time * face.velocity;
  };
  const Surface& from = face.surface;
  if (from.is_plane()) return Surface::plane(turn * from.normal, moved(from.offset * from.normal));
  return Surface::cylinder(turn * from.axis, moved(from.point), from.radius);
}

/// Bounds of a cylinder between its ends.
Extent extent_of_cylinder(const Container& container) {
  const Surface& shell = container.faces[*cylinder_of(container)].surface;
  const Vector reach = shell.radius * (1.0 - shell.axis.array().square()).max(0.0).sqrt();
  Extent extent;
  for (const int end : ends_of_cylinder(container)) {
    const Surface& plane = container.faces[end].surface;
    const Vector centre = shell.point + plane.distance(shell.point) * plane.normal;
    const Vector low = centre - reach, high = centre + reach;
    extent.lower = extent.empty ? low : Vector(extent.lower.cwiseMin(low));
    extent.upper = extent.empty ? high : Vector(extent.upper.cwiseMax(high));
    extent.empty = false;
  }
  return extent;
}

}  // namespace

std::optional<int> cylinder_of(const Container& container) {
  for (int f = 0; f < container.face_count(); ++f)
    if (!container.faces[f].surface.is_plane()) return f;
  return {};
}

std::array<int, 2> ends_of_cylinder(const Container& container) {
  const Vector& axis = container.faces[*cylinder_of(container)].surface.axis;
  std::array<int, 2> ends{-1, -1};
  for (int f = 0; f < container.face_count(); ++f) {
    const Surface& surface = container.faces[f].surface;
    if (!surface.is_plane()) continue;
    ends[surface.normal.dot(axis) > 0.0 ? 1 : 0] = f;
  }
  return ends;
}

int periodic_axis(const Container& container, int face) {
  const Surface& surface = container.faces[face].surface;
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis] && surface.is_plane() && std::abs(surface.normal[axis]) == 1.0) return axis;
  return -1;
}

bool any_face_moves(const Container& container) {
  return std::any_of(container.faces.begin(), container.faces.end(), [](const ContainerFace& face) {
    return !face.velocity.isZero(0.0) || !face.angular_velocity.isZero(0.0);
  });
}

ContainerGeometry geometry_after(const Container& container, double time, const Vector& origin) {
  if (time == 0.0 || !any_face_moves(container)) return geometry_of(container, origin);
  if (container.is_box) {
    Vector lower = container.lower, stretching = Vector::Zero();
    for (const ContainerFace& face : container.faces) {
      stretching += face.surface.normal.cwiseAbs().cwiseProduct(face.velocity)
                        .cwiseProduct(face.surface.normal);
      lower += (-face.surface.normal).cwiseMax(0.0).cwiseProduct(time * face.velocity);
    }
    return geometry_of_box(container, lower, container.upper - container.lower + time * stretching, origin);
  }
  return geometry_of(container_after(container, time), origin);
}

Container container_after(const Container& container, double time) {
  Container moved = container;
  for (ContainerFace& face : moved.faces) {
    face.surface = surface_after(face, time);
    face.pivot += time * face.velocity;
  }
  return moved;
}

ContainerGeometry geometry_of(const Container& container, const Vector& origin) {
  if (container.is_box)
    return geometry_of_box(container, container.lower, container.upper - container.lower, origin);
  if (cylinder_of(container)) return geometry_of_cylinder(container, origin);
  return geometry_of_polyhedron(container, origin);
}

void find_bounds(Container& container) {
  if (container.is_box) return;
  Extent extent;
  if (cylinder_of(container)) {
    extent = extent_of_cylinder(container);
  } else {
    std::vector<Surface> planes;
    for (const ContainerFace& face : container.faces) planes.push_back(face.surface);
    extent = extent_of(polygons_of(planes));
  }
  container.lower = extent.lower;
  container.upper = extent.upper;
}

double volume_of(const Container& container) {
  return geometry_of(container, container.lower).volume;
}

std::vector<double> face_areas(const Container& container) {
  return geometry_of(container, container.lower).areas;
}

}  // namespace pfv
