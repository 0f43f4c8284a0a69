// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_volumes.hpp"

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;

CellVolume tetrahedron(const Vector& b, const Vector& c, const Vector& d) {
  CellVolume result;
  result.gradient[1] = c.cross(d) / 6.0;
  result.gradient[2] = d.cross(b) / 6.0;
  result.gradient[3] = b.cross(c) / 6.0;
  result.gradient[0] = -(result.gradient[1] + result.gradient[2] + result.gradient[3]);
  result.volume = b.dot(result.gradient[1]);
  return result;
}

/// Triangle (a, a+b, a+c) and its projection on the wall with outward normal w; `height` is the mean
/// distance of its corners from the wall.
CellVolume prism(const Vector& b, const Vector& c, const Vector& w, double height) {
  CellVolume result;
  const double base = 0.5 * b.cross(c).dot(w);
  result.volume = base * height;
  const Vector lower = -base / 3.0 * w;
  result.gradient[1] = 0.5 * height * c.cross(w);
  result.gradient[2] = 0.5 * height * w.cross(b);
  result.gradient[0] = -(result.gradient[1] + result.gradient[2]) + lower;
  result.gradient[1] += lower;
  result.gradient[2] += lower;
  result.gradient[3] = base * w;
  return result;
}

/// Edge (a, a+b) and its projections on two walls; u and v are the distances of its ends from them.
CellVolume slab(const Vector& b, const Vector& w1, const Vector& w2, double ua, double va,
                double ub, double vb) {
  CellVolume result;
  const Vector along = w1.cross(w2);
  const double length = b.dot(along);
  const double section = (2.0 * ua * va + 2.0 * ub * vb + ua * vb + ub * va) / 6.0;
  result.volume = length * section;
  result.gradient[0] = -section * along - length * (2.0 * va + vb) / 6.0 * w1 -
                       length * (2.0 * ua + ub) / 6.0 * w2;
  result.gradient[1] = section * along - length * (2.0 * vb + va) / 6.0 * w1 -
                       length * (2.0 * ub + ua) / 6.0 * w2;
  result.gradient[2] = length * (va + vb) / 2.0 * w1;
  result.gradient[3] = length * (ua + ub) / 2.0 * w2;
  return result;
}

CellVolume block(const Vector& w1, const Vector& w2, const Vector& w3, double h1, double h2,
                 double h3) {
  CellVolume result;
  result.volume = h1 * h2 * h3;
  result.gradient[1] = h2 * h3 * w1;
  result.gradient[2] = h3 * h1 * w2;
  result.gradient[3] = h1 * h2 * w3;
  result.gradient[0] = -(result.gradient[1] + result.gradient[2] + result.gradient[3]);
  return result;
}

}  // namespace

CellVolume cell_volume(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  const int a = cell[0];
  const Vector b = spheres.towards(a, cell[1]);
  const Vector c = spheres.towards(a, cell[2]);
  const Vector d = spheres.towards(a, cell[3]);
  const auto height = [&](int k, Vertex wall) { return spheres.distance(k, wall_number(wall)); };
  if (!is_wall(cell[3])) return tetrahedron(b, c, d);
  if (!is_wall(cell[2])) {
    const double mean =
        (height(a, cell[3]) + height(cell[1], cell[3]) + height(cell[2], cell[3])) / 3.0;
    return prism(b, c, d, mean);
  }
  if (!is_wall(cell[1]))
    return slab(b, c, d, height(a, cell[2]), height(a, cell[3]), height(cell[1], cell[2]),
                height(cell[1], cell[3]));
  return block(b, c, d, height(a, cell[1]), height(a, cell[2]), height(a, cell[3]));
}

}  // namespace pfv
