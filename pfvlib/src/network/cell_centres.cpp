// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/cell_centres.hpp"

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

/// Rows normal . y = offset for y = P - (centre of the first sphere): radical planes with the other
/// spheres, and wall planes. Spheres come first in a cell, so the base is always a sphere: with a
/// wall's own equation no digits are lost.
template <class Number>
std::array<Row<Number>, 3> plane_rows(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  std::array<Row<Number>, 3> rows;
  const int base = cell[0];
  const Number base_radius(spheres.radii[base]);
  for (int i = 0; i < 3; ++i) {
    const Vertex vertex = cell[i + 1];
    Row<Number>& row = rows[i];
    if (is_wall(vertex)) {
      const int face = wall_number(vertex), axis = face / 2;
      row.normal = {Number(0), Number(0), Number(0)};
      row.normal[axis] = Number(1);
      row.offset = Number(face % 2 ? spheres.edges[axis] : 0.0) - Number(spheres.centres(axis, base));
      continue;
    }
    Number squared(0);
    for (int axis = 0; axis < 3; ++axis) {
      const Number d = Number(spheres.centres(axis, vertex)) - Number(spheres.centres(axis, base));
      row.normal[axis] = d;
      squared += d * d;
    }
    const Number radius(spheres.radii[vertex]);
    row.offset = (squared + (base_radius - radius) * (base_radius + radius)) / Number(2);
  }
  return rows;
}

template <class Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Number dot(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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

/// Exact topology puts every dual vertex inside the box; what is left outside is rounding.
Eigen::Vector3d inside(const Eigen::Vector3d& point, const std::array<Vertex, 4>& cell,
                       const Spheres& spheres) {
  Eigen::Vector3d moved = point;
  for (int axis = 0; axis < 3; ++axis)
    if (!spheres.periodic[axis])
      moved[axis] = std::min(std::max(moved[axis], 0.0), spheres.edges[axis]);
  for (const Vertex vertex : cell) {
    if (!is_wall(vertex)) continue;
    const int face = wall_number(vertex);
    moved[face / 2] = face % 2 ? spheres.edges[face / 2] : 0.0;
  }
  return moved;
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
    centres.places.col(c) = inside(spheres.centres.col(cell[0]) + y, cell, spheres);
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
