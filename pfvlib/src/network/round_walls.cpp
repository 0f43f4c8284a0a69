// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/round_walls.hpp"

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;
using InSection = Eigen::Vector2d;

RoundPlace round_place(const WallSurface& wall, const Vector& place) {
  return {wall.in_section(place), wall.height(place)};
}
RadialSweep sweep(const WallSurface& wall, const Vector& a, const Vector& b) {
  return {round_place(wall, a), round_place(wall, b)};
}
Vector in_space(const WallSurface& wall, const InSection& v) { return v.x() * wall.first + v.y() * wall.second; }
/// A vector of the section turned by a right angle: axis x v.
InSection turned(const InSection& v) { return {-v.y(), v.x()}; }

/// The prism from a triangle, counterclockwise as seen from the wall, out to the wall: its volume and its base. By
/// the divergence theorem, with the field (R²/rho² - 1) x_section / 2, whose divergence is -1.
struct Prism {
  double volume, base;
};
Prism prism(const WallSurface& wall, const std::array<Vector, 3>& corners) {
  double height_angle = 0.0;
  InSection middle = InSection::Zero();
  for (int i = 0; i < 3; ++i) {
    height_angle += sweep(wall, corners[i], corners[(i + 1) % 3]).height_angle;
    middle += wall.in_section(corners[i]) / 3.0;
  }
  const Vector area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double radius = wall.surface.radius;
  return {-0.5 * (radius * radius * height_angle + area.dot(in_space(wall, middle))), -radius * height_angle};
}

/// Height of a plane across the cylinder; its outward normal is `sign` times the axis.
struct End {
  double height, sign;
};
End end_of(const WallSurface& round, const WallSurface& plane) {
  const double sign = plane.surface.normal.dot(round.surface.axis) > 0.0 ? 1.0 : -1.0;
  return {sign * plane.surface.distance(round.surface.point), sign};
}

/// A cell's or facet's round wall and end, and +1 where the round one comes first.
struct RoundAndEnd {
  const WallSurface& round;
  End end;
  double order;
};
RoundAndEnd round_and_end(Vertex first, Vertex second, const Spheres& spheres) {
  const bool round_first = is_round(first, spheres);
  const WallSurface& round = spheres.wall(round_first ? first : second);
  return {round, end_of(round, spheres.wall(round_first ? second : first)), round_first ? 1.0 : -1.0};
}

/// Of a loop on the wall, counterclockwise as seen from outside: integrals of r dz and z r dz.
struct Loop {
  InSection rise = InSection::Zero(), moment = InSection::Zero();

  void trace(const WallSurface& wall, const Vector& a, const Vector& b, double sign = 1.0) {
    const RadialSweep s = sweep(wall, a, b);
    rise += sign * s.rise * s.direction;
    moment += sign * s.rise * (wall.height(a) * s.direction + s.rise * s.direction_t);
  }
  void upright(const WallSurface& wall, const Vector& at, double from, double to, double sign) {
    const InSection r = wall.in_section(at).normalized();
    rise += sign * (to - from) * r;
    moment += sign * 0.5 * (to * to - from * from) * r;
  }
  /// By Green's theorem, with r d(theta) = -d(theta's unit vector).
  WallPart part(const WallSurface& wall, double area) const {
    const double radius = wall.surface.radius;
    const Vector vector = in_space(wall, -radius * turned(rise));
    return {area, vector, wall.surface.point.cross(vector) + radius * in_space(wall, moment)};
  }
};

/// Between the trace of a segment on an end and the round wall.
WallPart end_part(const RoundAndEnd& walls, const Vector& a, const Vector& b) {
  const WallSurface& wall = walls.round;
  const RadialSweep s = sweep(wall, a, b);
  const InSection at_a = wall.in_section(a), at_b = wall.in_section(b);
  const double radius = wall.surface.radius, turn = -walls.order * walls.end.sign;
  const double area = turn * s.end_area(radius);
  const InSection sector = -turned(at_b.normalized() - at_a.normalized()) * (radius * radius * radius / 3.0);
  const InSection triangle = s.twice_area * (at_a + at_b) / 6.0;
  const Vector normal = walls.end.sign * wall.surface.axis;
  const Vector centre = area * (wall.surface.point + walls.end.height * wall.surface.axis) +
                        turn * in_space(wall, sector - triangle);
  return {area, area * normal, centre.cross(normal)};
}

}  // namespace

int round_corner(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  for (int i = 1; i < 4; ++i)
    if (is_round(cell[i], spheres)) return i;
  return -1;
}

Eigen::Vector3d swept_area(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const WallSurface& wall = spheres.wall(facet[2]);
  const Vector a = spheres.centres.col(facet[0]), b = spheres.centres.col(facet[1]);
  const RadialSweep s = sweep(wall, a, b);
  const InSection out =
      wall.surface.radius * s.direction - 0.5 * (wall.in_section(a) + wall.in_section(b));
  return s.rise * in_space(wall, turned(out)) - s.end_area(wall.surface.radius) * wall.surface.axis;
}

double cone_on_swept(const std::array<Vertex, 3>& facet, const Spheres& spheres, const Eigen::Vector3d& place) {
  const WallSurface& wall = spheres.wall(facet[2]);
  const RadialSweep s = sweep(wall, spheres.centres.col(facet[0]), spheres.centres.col(facet[1]));
  const double radius = wall.surface.radius;
  // integral of x . n over the facet, with x from the point of the axis
  const double flux = -0.5 * (radius * radius * s.height_angle - s.twice_area * s.mean_height);
  return ((place - wall.surface.point).dot(swept_area(facet, spheres)) - flux) / 3.0;
}

std::array<double, 3> strips_on_walls(const std::array<Vertex, 3>& facet, const Spheres& spheres,
                                      const Eigen::Vector3d& place, int side) {
  std::array<double, 3> strips{0.0, 0.0, 0.0};
  const Vector a = spheres.centres.col(facet[0]);
  if (!is_wall(facet[1])) {
    const Vector b = spheres.centres.col(facet[1]);
    const WallSurface& wall = spheres.wall(facet[2]);
    strips[2] = side == 0 ? prism(wall, {a, b, place}).base : prism(wall, {b, a, place}).base;
    return strips;
  }
  const RoundAndEnd walls = round_and_end(facet[1], facet[2], spheres);
  const RadialSweep s = sweep(walls.round, a, place);
  const double radius = walls.round.surface.radius, sign = side == 0 ? -walls.order : walls.order;
  strips[walls.order > 0.0 ? 1 : 2] = sign * s.wall_area_below(walls.end.height, radius);
  strips[walls.order > 0.0 ? 2 : 1] = -sign * walls.end.sign * s.end_area(radius);
  return strips;
}

double round_cell_volume(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  const auto at = [&](int i) { return Vector(spheres.centres.col(cell[i])); };
  if (!is_wall(cell[2])) return prism(spheres.wall(cell[3]), {at(0), at(1), at(2)}).volume;
  const RoundAndEnd walls = round_and_end(cell[2], cell[3], spheres);
  return walls.order *
         sweep(walls.round, at(0), at(1)).volume_below(walls.end.height, walls.round.surface.radius);
}

WallPart round_base(const std::array<Vertex, 4>& cell, int i, const Spheres& spheres) {
  const auto at = [&](int k) { return Vector(spheres.centres.col(cell[k])); };
  Loop loop;
  if (!is_wall(cell[2])) {
    const WallSurface& wall = spheres.wall(cell[3]);
    for (int k = 0; k < 3; ++k) loop.trace(wall, at(k), at((k + 1) % 3));
    return loop.part(wall, prism(wall, {at(0), at(1), at(2)}).base);
  }
  const RoundAndEnd walls = round_and_end(cell[2], cell[3], spheres);
  if (!is_round(cell[i], spheres)) return end_part(walls, at(0), at(1));
  const WallSurface& wall = walls.round;
  const double order = walls.order, z = walls.end.height;
  loop.trace(wall, at(0), at(1), -order);
  loop.upright(wall, at(0), wall.height(at(0)), z, order);
  loop.upright(wall, at(1), z, wall.height(at(1)), order);
  return loop.part(wall, order * sweep(wall, at(0), at(1)).wall_area_below(z, wall.surface.radius));
}

}  // namespace pfv
