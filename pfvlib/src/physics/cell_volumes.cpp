// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_volumes.hpp"

#include "network/facets.hpp"

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

/// `slab` by the legs of its ends, 2 u v - c (u² + v²) = u leg + v second_leg.
CellVolume narrow_slab(const Vector& b, const WallPair& at_a, const WallPair& at_b) {
  CellVolume result;
  const Vector &w1 = at_a.first, &w2 = at_a.second, &along = at_a.along;
  const double length = b.dot(along) / at_a.sine2;
  const auto mean = [](double a, double b, double x, double y) { return (2.0 * a * x + 2.0 * b * y + a * y + b * x) / 6.0; };
  const double section = 0.5 / at_a.sine2 * (mean(at_a.u, at_b.u, at_a.leg, at_b.leg) +
                                             mean(at_a.v, at_b.v, at_a.second_leg, at_b.second_leg));
  result.volume = b.dot(along) * section;
  const Vector of_a = length / 6.0 * ((2.0 * at_a.leg + at_b.leg) * w1 + (2.0 * at_a.second_leg + at_b.second_leg) * w2);
  const Vector of_b = length / 6.0 * ((2.0 * at_b.leg + at_a.leg) * w1 + (2.0 * at_b.second_leg + at_a.second_leg) * w2);
  result.gradient[0] = -section * along - of_a;
  result.gradient[1] = section * along - of_b;
  result.gradient[2] = 0.5 * length * (at_a.leg + at_b.leg) * w1;
  result.gradient[3] = 0.5 * length * (at_a.second_leg + at_b.second_leg) * w2;
  return result;
}

/// Edge (a, a+b) and its feet on two walls; `at_a` and `at_b`: the walls as its ends see them.
CellVolume slab(const Vector& b, const WallPair& at_a, const WallPair& at_b) {
  CellVolume result;
  if (at_a.narrow) return narrow_slab(b, at_a, at_b);
  const Vector &w1 = at_a.first, &w2 = at_a.second, &along = at_a.along;
  const double ua = at_a.u, va = at_a.v, ub = at_b.u, vb = at_b.v, c = at_a.c, sine2 = at_a.sine2;
  const double length = b.dot(along);
  const double uv = (2.0 * ua * va + 2.0 * ub * vb + ua * vb + ub * va) / 6.0;
  const double squares = (ua * ua + ua * ub + ub * ub + va * va + va * vb + vb * vb) / 3.0;
  const double section = (2.0 * uv - c * squares) / (2.0 * sine2);
  result.volume = length * section;
  const Vector of_a1 = length * ((2.0 * va + vb) - c * (2.0 * ua + ub)) / 6.0 / sine2 * w1;
  const Vector of_a2 = length * ((2.0 * ua + ub) - c * (2.0 * va + vb)) / 6.0 / sine2 * w2;
  result.gradient[0] = -section * along - of_a1 - of_a2;
  result.gradient[1] = section * along - length * ((2.0 * vb + va) - c * (2.0 * ub + ua)) / 6.0 / sine2 * w1 -
                       length * ((2.0 * ub + ua) - c * (2.0 * vb + va)) / 6.0 / sine2 * w2;
  result.gradient[2] = length * ((va + vb) - c * (ua + ub)) / 2.0 / sine2 * w1;
  result.gradient[3] = length * ((ua + ub) - c * (va + vb)) / 2.0 / sine2 * w2;
  return result;
}

/// The corner in which three walls meet. A wall's part of it are two right triangles, which end at the edges with
/// the two others; where a foot lies beyond an edge they are negative.
CellVolume block(int k, const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  CellVolume result;
  const Vector centre = spheres.centres.col(k);
  const Vector apex = corner_of_walls(cell[1], cell[2], cell[3], spheres) - centre;
  result.gradient[0].setZero();
  for (int i = 1; i < 4; ++i) {
    const Vertex next = cell[i % 3 + 1], last = cell[(i + 1) % 3 + 1];
    const WallPair with_next(k, cell[i], next, spheres), with_last(k, cell[i], last, spheres);
    double area;
    if (with_next.c == 0.0 && with_last.c == 0.0 && with_next.second.dot(with_last.second) == 0.0) {
      area = with_next.v * with_last.v;
    } else {
      const Vector foot = with_next.u * with_next.first;
      area = 0.5 * ((with_next.to_edge() - foot).cross(apex - foot) + (apex - foot).cross(with_last.to_edge() - foot))
                       .dot(with_next.first);
    }
    result.gradient[i] = area * with_next.first;
    result.gradient[0] -= result.gradient[i];
    result.volume += with_next.u * area / 3.0;
  }
  return result;
}

}  // namespace

CellVolume cell_volume(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  if (round_corner(cell, spheres) > 0) {
    CellVolume result;
    result.volume = round_cell_volume(cell, spheres);
    result.gradient.fill(Vector::Zero());
    return result;
  }
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
    return slab(b, {a, cell[2], cell[3], spheres}, {cell[1], cell[2], cell[3], spheres});
  return block(a, cell, spheres);
}

}  // namespace pfv
