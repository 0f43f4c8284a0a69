// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/mesh_walls.hpp"

#include "geometry/pi.hpp"
#include "pfv/error.hpp"
#include "problem/round_meshes.hpp"
#include "text/number_text.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;
using Triangles = std::vector<Triangle>;

constexpr double squareness = 1e-4;   // cosines of directions that are taken as square to each other
constexpr std::size_t most_planes = 4096;  // of a mesh: finding them costs planes times triangles
constexpr int fewest_flats = 16;      // around an axis: they lie within 2 % of the radius from its cylinder
constexpr double roundness = 0.02;    // strays from a cylinder, as parts of its radius
constexpr double whole_turn = 0.95;   // part of the way around that a cylinder's triangles cover at least

struct Bulk {
  Vector middle = Vector::Zero();
  double size = 0.0;  ///< m, the longest edge of the box around it
};

Bulk bulk_of(const Triangles& triangles) {
  Bulk bulk;
  Vector low = triangles[0].col(0), high = low;
  for (const Triangle& triangle : triangles) {
    bulk.middle += triangle.rowwise().mean() / static_cast<double>(triangles.size());
    low = low.cwiseMin(triangle.rowwise().minCoeff());
    high = high.cwiseMax(triangle.rowwise().maxCoeff());
  }
  bulk.size = (high - low).maxCoeff();
  return bulk;
}

/// Half the cross product of two edges.
Vector area_of(const Triangle& t) { return 0.5 * (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)); }

double furthest_from(const Surface& surface, const MeshWall& wall, const Triangles& triangles) {
  double furthest = 0.0;
  for (const int t : wall.triangles)
    for (int k = 0; k < 3; ++k) furthest = std::max(furthest, std::abs(surface.distance(triangles[t].col(k))));
  return furthest;
}

/// The plane nearest to the corners of some triangles, with `inside` on its inner side.
Surface plane_of(const std::vector<int>& chosen, const Triangles& triangles, const Vector& inside) {
  Vector middle = Vector::Zero();
  for (const int t : chosen) middle += triangles[t].rowwise().mean() / static_cast<double>(chosen.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int t : chosen) {
    const Triangle from = triangles[t].colwise() - middle;
    spread += from * from.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(spread);
  Vector normal = solved.eigenvectors().col(0);
  for (int axis = 0; axis < 3; ++axis)  // a plane normal to an axis is so to the last digit
    if (std::abs(normal[axis]) > 1.0 - 1e-12) normal = Vector::Unit(axis);
  Surface plane = Surface::plane(normal, middle);
  if (plane.distance(inside) < 0.0) plane = Surface::plane(-normal, middle);
  return plane;
}

bool lies_on(const Surface& plane, const Triangle& triangle, const Bulk& bulk) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(plane.distance(triangle.col(k))) > planarity * bulk.size) return false;
  return true;
}

/// Joins groups that lie on one plane, which only all of a group's triangles together show.
void join_coplanar(std::vector<MeshWall>& walls, const Triangles& triangles, const Bulk& bulk) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    MeshWall& wall = walls[w];
    wall.surface = plane_of(wall.triangles, triangles, bulk.middle);
    for (std::size_t other = w + 1; other < walls.size();) {
      const std::vector<int>& others = walls[other].triangles;
      const bool joins = std::all_of(others.begin(), others.end(), [&](int t) { return lies_on(wall.surface, triangles[t], bulk); });
      if (!joins) {
        ++other;
        continue;
      }
      wall.triangles.insert(wall.triangles.end(), others.begin(), others.end());
      wall.surface = plane_of(wall.triangles, triangles, bulk.middle);
      walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(other));
    }
    std::sort(wall.triangles.begin(), wall.triangles.end());
    wall.deviation = furthest_from(wall.surface, wall, triangles);
  }
}

/// The triangles by the planes that they lie on, the largest first: its plane is the surest.
std::vector<MeshWall> coplanar_groups(const Triangles& triangles, const Bulk& bulk, const std::string& what) {
  std::vector<int> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return area_of(triangles[a]).squaredNorm() > area_of(triangles[b]).squaredNorm();
  });
  std::vector<MeshWall> walls;
  for (const int t : order) {
    const auto found = std::find_if(walls.begin(), walls.end(), [&](const MeshWall& wall) {
      return lies_on(wall.surface, triangles[t], bulk);
    });
    if (found != walls.end()) {
      found->triangles.push_back(t);
      continue;
    }
    const Vector area = area_of(triangles[t]);
    if (!(area.norm() > planarity * planarity * bulk.size * bulk.size)) continue;  // a needle: it has no plane
    if (walls.size() == most_planes)
      throw InputError(what + "has more than " + std::to_string(most_planes) +
                       " planes: it is curved in more than one direction, or too fine for its shape");
    walls.push_back({Surface::plane(area, triangles[t].col(0)), {t}, 0.0, {}});
  }
  join_coplanar(walls, triangles, bulk);
  std::sort(walls.begin(), walls.end(),
            [](const MeshWall& a, const MeshWall& b) { return a.triangles[0] < b.triangles[0]; });
  return walls;
}

/// How surely the plane of a wall is known at the mesh's far end: the less the narrower the wall is.
double sureness(const MeshWall& wall, const Triangles& triangles, const Bulk& bulk) {
  double area = 0.0;
  for (const int t : wall.triangles) area += area_of(triangles[t]).norm();
  return 2.0 * planarity * bulk.size * std::max(1.0, bulk.size * bulk.size / area);
}

void require_convex(const std::vector<MeshWall>& walls, const Triangles& triangles, const Bulk& bulk,
                    const std::string& what) {
  for (const MeshWall& wall : walls) {
    const double allowed = sureness(wall, triangles, bulk);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      double beyond = 0.0;
      for (int k = 0; k < 3; ++k) beyond = std::max(beyond, -wall.surface.distance(triangles[t].col(k)));
      if (beyond <= allowed) continue;
      throw InputError(what + "is not convex: its triangle " + std::to_string(t + 1) +
                       " reaches beyond the plane of triangle " + std::to_string(wall.triangles[0] + 1) +
                       " by " + detail::number_text(beyond) +
                       " m; the fluid's container is convex: give its parts as meshes of their own and leave "
                       "out those that stand inside");
    }
  }
}

/// Planes that go around an axis, and those square to it.
struct Around {
  Vector axis = Vector::Zero();
  std::vector<int> sides, ends;
};

Around around(const Vector& axis, const std::vector<MeshWall>& walls) {
  Around result;
  result.axis = axis;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const double cosine = std::abs(walls[w].surface.normal.dot(axis));
    if (cosine < squareness) result.sides.push_back(static_cast<int>(w));
    if (cosine > 1.0 - squareness) result.ends.push_back(static_cast<int>(w));
  }
  return result;
}

/// The axis that all planes go around or are square to, if there is one.
std::optional<Around> common_axis(const std::vector<MeshWall>& walls) {
  if (static_cast<int>(walls.size()) < fewest_flats) return {};
  // of three planes two go around it, since ends all have one direction
  for (const int a : {0, 1, 2})
    for (std::size_t b = a + 1; b < walls.size(); ++b) {
      const Vector axis = walls[a].surface.normal.cross(walls[b].surface.normal);
      if (!(axis.norm() > 1e-2)) continue;
      const Around found = around(axis.normalized(), walls);
      if (found.sides.size() + found.ends.size() == walls.size() && static_cast<int>(found.sides.size()) >= fewest_flats)
        return found;
    }
  return {};
}

/// The axis of the flats, better than from two of them: the direction that their normals have least of.
Vector axis_of_sides(const std::vector<Vector>& normals) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector& normal : normals) spread += normal * normal.transpose();
  Vector axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  for (int k = 0; k < 3; ++k)
    if (std::abs(axis[k]) > 1.0 - 1e-10) axis = Vector::Unit(k);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Vector(-axis) : axis;
}

/// Normals to the triangles of a wall.
std::vector<Vector> normals_of(const std::vector<int>& chosen, const Triangles& triangles) {
  std::vector<Vector> normals;
  for (const int t : chosen)
    if (const Vector area = area_of(triangles[t]); area.norm() > 0.0) normals.push_back(area.normalized());
  return normals;
}

/// The cylinder of the cross-section that the triangles enclose: its axis is nearest to being square to their
/// normals, its middle that of the circle nearest to their corners (least squares of squares), its area
/// the perimeter times the flats' mean distance over two.
Surface fitted_cylinder(const std::vector<int>& chosen, const Triangles& triangles) {
  const Vector axis = axis_of_sides(normals_of(chosen, triangles));
  const Vector u = axis.unitOrthogonal(), v = axis.cross(u);
  const Vector origin = triangles[chosen[0]].col(0);
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Vector right = Vector::Zero();
  for (const int t : chosen)
    for (int k = 0; k < 3; ++k) {
      const Vector from = triangles[t].col(k) - origin;
      const Vector row(from.dot(u), from.dot(v), 1.0);
      normal_matrix += row * row.transpose();
      right += row.head<2>().squaredNorm() * row;
    }
  const Vector fit = normal_matrix.ldlt().solve(right);
  const Vector centre = origin + 0.5 * fit[0] * u + 0.5 * fit[1] * v;
  // sum of area times distance = 2 (cross-section) (length); sum of area = perimeter times length
  const Surface line = Surface::cylinder(axis, centre, 0.0);
  double volume = 0.0, areas = 0.0, corner = 0.0;
  for (const int t : chosen) {
    const Vector area = area_of(triangles[t]);
    volume += std::abs(area.dot(triangles[t].col(0) - centre));
    areas += area.norm();
    for (int k = 0; k < 3; ++k) corner = std::max(corner, -line.distance(triangles[t].col(k)));
  }
  // n equal flats: mean distance d = R cos(pi/n), cross-section n d^2 tan(pi/n)
  const double half = std::acos(std::clamp(volume / areas / corner, 0.0, 1.0));
  const double section = half > 0.0 ? std::tan(half) / half : 1.0;
  return Surface::cylinder(axis, centre, volume / areas * std::sqrt(section));
}

/// How far the flats lie from it: their corners outside, their middles inside.
double strays_from(const Surface& cylinder, const MeshWall& wall, const Triangles& triangles) {
  double furthest = furthest_from(cylinder, wall, triangles);
  for (const int t : wall.triangles) {
    const Vector normal = area_of(triangles[t]).normalized();
    const double flat = std::abs(normal.dot(triangles[t].col(0) - cylinder.point));
    if (normal.allFinite()) furthest = std::max(furthest, cylinder.radius - flat);
  }
  return furthest;
}

/// Part of the way around the axis that the triangles cover.
double turn_of(const Surface& cylinder, const MeshWall& wall, const Triangles& triangles) {
  double area = 0.0, low = 0.0, high = 0.0;
  for (const int t : wall.triangles) {
    area += area_of(triangles[t]).norm();
    const Eigen::RowVector3d along = cylinder.axis.transpose() * (triangles[t].colwise() - cylinder.point);
    low = std::min(low, along.minCoeff());
    high = std::max(high, along.maxCoeff());
  }
  return area / (2.0 * pi * cylinder.radius * (high - low));
}

/// Puts a cylinder in place of the flats, if they are one.
void make_round(std::vector<MeshWall>& walls, const Triangles& triangles) {
  const std::optional<Around> found = common_axis(walls);
  if (!found) return;
  MeshWall round;
  for (const int side : found->sides)
    round.triangles.insert(round.triangles.end(), walls[side].triangles.begin(), walls[side].triangles.end());
  std::sort(round.triangles.begin(), round.triangles.end());
  round.surface = fitted_cylinder(round.triangles, triangles);
  round.deviation = strays_from(round.surface, round, triangles);
  if (!(round.deviation < roundness * round.surface.radius)) return;
  if (!(turn_of(round.surface, round, triangles) > whole_turn)) return;
  std::vector<MeshWall> result{round};
  for (const int end : found->ends) result.push_back(walls[end]);
  walls = std::move(result);
}

/// Planes that bound a convex room, or one that is round.
std::vector<MeshWall> walls_as_they_are(const Triangles& triangles, RoundMeshes round, const std::string& what) {
  const Bulk bulk = bulk_of(triangles);
  std::vector<MeshWall> walls = coplanar_groups(triangles, bulk, what);
  if (walls.empty()) throw InputError(what + "has no area");
  require_convex(walls, triangles, bulk, what);
  if (round == RoundMeshes::as_cylinders) make_round(walls, triangles);
  return walls;
}

/// Where a mesh has come to that was at its anchors, as a rigid body.
Eigen::Isometry3d motion_of(const MeshAnchors& anchors, const Triangles& triangles) {
  Eigen::Matrix3d places;
  for (int k = 0; k < 3; ++k) places.col(k) = triangles[anchors.corners[k].first].col(anchors.corners[k].second);
  const auto frame = [](const Eigen::Matrix3d& corners) {
    Eigen::Matrix3d axes;
    axes.col(0) = (corners.col(1) - corners.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(corners.col(2) - corners.col(0)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  };
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = frame(places) * frame(anchors.places).transpose();
  motion.translation() = places.col(0) - motion.linear() * anchors.places.col(0);
  return motion;
}

}  // namespace

std::vector<MeshWall> walls_of_mesh(const Triangles& triangles, RoundMeshes round, const std::string& what) {
  if (triangles.empty()) throw InputError(what + "has no triangles");
  constexpr std::size_t many = most_faces - 4;
  try {
    std::vector<MeshWall> walls = walls_as_they_are(triangles, round, what);
    if (walls.size() > many)
      if (std::optional<std::vector<MeshWall>> fewer = walls_of_revolution(triangles, round)) return *std::move(fewer);
    return walls;
  } catch (const InputError&) {
    if (std::optional<std::vector<MeshWall>> around = walls_of_revolution(triangles, round)) return *std::move(around);
    throw;
  }
}

std::vector<Surface> flats_around(const Surface& cylinder, const std::vector<Surface>& beside) {
  constexpr int equal = 32;  // they conduct 0.6 % more than the cylinder
  const Vector u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
  std::vector<double> angles;
  for (const Surface& plane : beside) {
    const double along = plane.normal.dot(u), across = plane.normal.dot(v);
    if (plane.is_plane() && std::hypot(along, across) > squareness) angles.push_back(std::atan2(across, along));
  }
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end(), [](double a, double b) { return b - a < squareness; }), angles.end());
  double widest = angles.empty() ? 2.0 * pi : angles.front() + 2.0 * pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  if (widest > 2.1 * pi / fewest_flats) {
    angles.clear();
    for (int k = 0; k < equal; ++k) angles.push_back((2 * k + 1) * pi / equal);
  }
  std::vector<Surface> flats;
  for (const double angle : angles) {
    const Vector normal = std::cos(angle) * u + std::sin(angle) * v;
    flats.push_back(Surface::plane(normal, cylinder.point + cylinder.radius * normal));
  }
  return flats;
}

void follow_mesh(MeshWall& wall, const Triangles& triangles, bool several) {
  if (wall.anchors) {
    const Eigen::Isometry3d motion = motion_of(*wall.anchors, triangles);
    const Surface before = wall.surface;
    wall.surface = before.is_plane() ? Surface::plane(motion.linear() * before.normal, motion * Vector(before.offset * before.normal))
                                     : Surface::cylinder(motion.linear() * before.axis, motion * before.point, before.radius);
    for (int k = 0; k < 3; ++k)
      wall.anchors->places.col(k) = triangles[wall.anchors->corners[k].first].col(wall.anchors->corners[k].second);
    return;
  }
  if (!wall.surface.is_plane()) {
    wall.surface = fitted_cylinder(wall.triangles, triangles);
    return;
  }
  const Surface before = wall.surface;
  wall.surface = plane_of(wall.triangles, triangles, bulk_of(triangles).middle);
  if (several || wall.surface.normal.dot(before.normal) >= 0.0) return;
  wall.surface.normal = -wall.surface.normal;
  wall.surface.offset = -wall.surface.offset;
}

}  // namespace pfv
