// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/cell_centres.hpp"

#include "network/facets.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace pfv {

namespace {

/// Wide enough for the triple products of differences of doubles that a sliver needs.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<512, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

/// Below this determinant (of rows of length one) rounding could exceed 1e-12 of the cell.
constexpr double sliver_determinant = 1e-3;

/// Below this one the cell is flat.
constexpr double flat_determinant = 1e-6;

template <class Number>
struct Row {
  std::array<Number, 3> normal;
  Number offset;
};

template <class Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Number dot(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
Row<Number> plane_row(const Surface& plane, const Eigen::Vector3d& base) {
  Row<Number> row;
  row.offset = Number(plane.offset);
  for (int axis = 0; axis < 3; ++axis) {
    row.normal[axis] = Number(plane.normal[axis]);
    row.offset -= row.normal[axis] * Number(base[axis]);
  }
  return row;
}

/// The radical plane of two spheres.
template <class Number>
Row<Number> radical_row(const Spheres& spheres, int base, int other) {
  Row<Number> row;
  Number squared(0);
  for (int axis = 0; axis < 3; ++axis) {
    const Number d = Number(spheres.centres(axis, other)) - Number(spheres.centres(axis, base));
    row.normal[axis] = d;
    squared += d * d;
  }
  const Number base_radius(spheres.radii[base]), radius(spheres.radii[other]);
  row.offset = (squared + (base_radius - radius) * (base_radius + radius)) / Number(2);
  return row;
}

/// Rows normal . y = offset for y = P - (centre of the first sphere): radical planes with the other
/// spheres, and wall planes. Spheres come first in a cell, so the base is always a sphere: with a
/// wall's own equation no digits are lost. In the place of a round wall stands the plane through the base
/// square to the line in which the two others meet; that line is followed to the wall afterwards.
template <class Number>
std::array<Row<Number>, 3> plane_rows(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  std::array<Row<Number>, 3> rows;
  int round = -1;
  for (int i = 0; i < 3; ++i) {
    const Vertex vertex = cell[i + 1];
    if (is_wall(vertex) && !spheres.wall(vertex).is_plane()) round = i;
    else if (is_wall(vertex)) rows[i] = plane_row<Number>(spheres.wall(vertex).surface, spheres.centres.col(cell[0]));
    else rows[i] = radical_row<Number>(spheres, cell[0], vertex);
  }
  if (round >= 0) {
    rows[round].normal = cross(rows[(round + 1) % 3].normal, rows[(round + 2) % 3].normal);
    rows[round].offset = Number(0);
  }
  return rows;
}

/// Cramer's rule. `quality` is the determinant for rows of length one.
template <class Number>
bool solve(const std::array<Row<Number>, 3>& rows, Eigen::Vector3d& y, double& quality) {
  const auto c0 = cross(rows[1].normal, rows[2].normal);
  const auto c1 = cross(rows[2].normal, rows[0].normal);
  const auto c2 = cross(rows[0].normal, rows[1].normal);
  const Number determinant = dot(rows[0].normal, c0);
  if (determinant == Number(0)) {
    quality = 0.0;
    return false;
  }
  double lengths = 1.0;
  for (const auto& row : rows)
    lengths *= std::sqrt(static_cast<double>(dot(row.normal, row.normal)));
  quality = std::abs(static_cast<double>(determinant)) / lengths;
  for (int axis = 0; axis < 3; ++axis)
    y[axis] = static_cast<double>((rows[0].offset * c0[axis] + rows[1].offset * c1[axis] +
                                   rows[2].offset * c2[axis]) /
                                  determinant);
  return true;
}

/// Exact topology puts every dual vertex inside the walls; what is left outside is rounding, and what flats stand
/// off a round wall.
void hold_inside(const WallSurface& wall, bool on_it, Eigen::Vector3d& place) {
  const double distance = wall.axis < 0 ? wall.surface.distance(place)
                          : wall.upper  ? wall.surface.offset - place[wall.axis]
                                        : wall.surface.offset + place[wall.axis];
  if (on_it || distance < 0.0) place = put_on(wall, place);
}

Eigen::Vector3d inside(const Eigen::Vector3d& point, const std::array<Vertex, 4>& cell,
                       const Spheres& spheres) {
  Eigen::Vector3d moved = point;
  for (const WallSurface& wall : spheres.walls)
    if (wall.axis < 0 || !spheres.periodic[wall.axis]) hold_inside(wall, false, moved);
  for (const Vertex vertex : cell)
    if (is_wall(vertex)) hold_inside(spheres.wall(vertex), true, moved);
  return moved;
}

/// The round wall of a cell, or 0.
Vertex round_wall(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  for (const Vertex vertex : cell)
    if (is_wall(vertex) && !spheres.wall(vertex).is_plane()) return vertex;
  return 0;
}

/// From a point of the line in which a cell's other two planes meet, along it to its round wall: outwards, as
/// the cell's orientation has it.
Eigen::Vector3d along_to_wall(const Eigen::Vector3d& point, const std::array<Vertex, 4>& cell,
                              Vertex round, const Spheres& spheres) {
  const WallSurface& wall = spheres.wall(round);
  const auto rows = plane_rows<double>(cell, spheres);
  int own = 0;
  for (int i = 0; i < 3; ++i)
    if (cell[i + 1] == round) own = i;
  Eigen::Vector3d way(rows[own].normal[0], rows[own].normal[1], rows[own].normal[2]);
  const Eigen::Vector3d second = spheres.towards(cell[0], cell[1]);
  const Eigen::Vector3d third = spheres.towards(cell[0], cell[cell[2] == round ? 3 : 2]);
  const Eigen::Vector3d outwards = cell[2] == round ? Eigen::Vector3d(third.cross(second))
                                                    : Eigen::Vector3d(second.cross(third));
  if (way.dot(outwards) < 0.0) way = -way;
  const Eigen::Vector2d from = wall.in_section(point);
  const Eigen::Vector2d d(wall.first.dot(way), wall.second.dot(way));
  const double a = d.squaredNorm(), b = from.dot(d);
  const double c = (from.norm() - wall.surface.radius) * (from.norm() + wall.surface.radius);
  if (!(a > 1e-24 * way.squaredNorm())) return point;  // it goes along the wall: `inside` does the rest
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  return point + (root - b) / a * way;
}

}  // namespace

CellCentres cell_centres(const Triangulation& triangulation, const Spheres& spheres) {
  const int cells = static_cast<int>(triangulation.vertices.size());
  CellCentres centres{Eigen::Matrix3Xd(3, cells), std::vector<char>(cells, 0)};
  std::vector<int> unsolved;
  for (int c = 0; c < cells; ++c) {
    const auto& cell = triangulation.vertices[c];
    Eigen::Vector3d y = Eigen::Vector3d::Zero();
    double quality = 0.0;
    if (!solve(plane_rows<double>(cell, spheres), y, quality) || quality < sliver_determinant)
      if (!solve(plane_rows<Wide>(cell, spheres), y, quality)) unsolved.push_back(c);
    centres.flat[c] = quality < flat_determinant;
    Eigen::Vector3d place = spheres.centres.col(cell[0]) + y;
    if (const Vertex round = round_wall(cell, spheres); round != 0)
      place = along_to_wall(place, cell, round, spheres);
    centres.places.col(c) = inside(place, cell, spheres);
  }
  // an exactly flat cell lies between cells with one dual vertex: it takes theirs
  for (const int c : unsolved)
    for (const int neighbour : triangulation.neighbours[c])
      if (neighbour >= 0 && !centres.flat[neighbour]) {
        centres.places.col(c) = centres.places.col(neighbour);
        break;
      }
  return centres;
}

}  // namespace pfv
