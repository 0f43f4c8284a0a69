// SPDX-License-Identifier: GPL-3.0-or-later
// Single throats against quadrature that shares no code with the library: phi and gamma by points
// of directions from each sphere and of volume, A^f by points of the facet.
#include "network/facets.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace throats_test {
namespace {

using namespace support;
using Vector = Eigen::Vector3d;

/// Corners of the facet's polygon in order.
std::vector<Vector> polygon_of(const Stages& s, int f) {
  const auto& facet = s.network.facet_vertices[f];
  const auto foot = [&](Vector x, int wall) {
    const int face = pfv::wall_number(wall);
    x[face / 2] = face % 2 ? s.spheres.edges[face / 2] : 0.0;
    return x;
  };
  const Vector a = s.spheres.centres.col(facet[0]);
  if (pfv::is_wall(facet[1]))
    return {a, foot(a, facet[1]), foot(foot(a, facet[1]), facet[2]), foot(a, facet[2])};
  const Vector b = s.spheres.centres.col(facet[1]);
  if (pfv::is_wall(facet[2])) return {a, b, foot(b, facet[2]), foot(a, facet[2])};
  return {a, b, s.spheres.centres.col(facet[2])};
}

struct Pyramid {
  std::array<Vector, 4> corner;  ///< three of the facet, then P
  double sign;                   ///< + when P lies on its own side of the facet
};

/// The throat's domain in tetrahedra: each triangle of the polygon with each of the two pores.
std::vector<Pyramid> domain_of(const Stages& s, int f) {
  const auto polygon = polygon_of(s, f);
  const Vector normal = pfv::unit_normal(s.network.facet_vertices[f], s.spheres);
  std::vector<Pyramid> pyramids;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const Vector p = s.network.cell_centres.col(s.network.facet_cells[f][side]);
      const double height = (side ? 1.0 : -1.0) * normal.dot(p - polygon[0]);
      pyramids.push_back({{polygon[0], polygon[i - 1], polygon[i], p}, height >= 0 ? 1.0 : -1.0});
    }
  return pyramids;
}

double volume_of(const Pyramid& t) {
  return std::abs((t.corner[1] - t.corner[0])
                      .cross(t.corner[2] - t.corner[0])
                      .dot(t.corner[3] - t.corner[0])) / 6.0;
}

/// Points of a low-discrepancy sequence in the unit cube (generalised golden ratio).
Vector sequence(int i) {
  const Vector x = (i + 0.5) * Vector(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  return x - x.unaryExpr([](double v) { return std::floor(v); });
}

/// The same in the unit square: a projection of the former would be far less even.
Eigen::Vector2d plane_sequence(int i) {
  const Eigen::Vector2d x = (i + 0.5) * Eigen::Vector2d(0.7548776662466927, 0.5698402909980532);
  return x - x.unaryExpr([](double v) { return std::floor(v); });
}

/// phi: volume of the domain outside the facet's own spheres, each subtracted on its own.
double phi_by_points(const Stages& s, int f, int points) {
  double sum = 0.0;
  for (const Pyramid& t : domain_of(s, f)) {
    double outside = 0.0;
    for (int i = 0; i < points; ++i) {
      Vector u = sequence(i);  // sorted: uniform barycentric coordinates
      std::sort(u.data(), u.data() + 3);
      const Vector x = u[0] * t.corner[0] + (u[1] - u[0]) * t.corner[1] +
                       (u[2] - u[1]) * t.corner[2] + (1.0 - u[2]) * t.corner[3];
      outside += 1.0;
      for (const int v : s.network.facet_vertices[f])
        if (!pfv::is_wall(v)) {
          const double r = s.spheres.radii[v];
          outside -= (x - s.spheres.centres.col(v)).squaredNorm() < r * r;
        }
    }
    sum += t.sign * volume_of(t) * outside / points;
  }
  return sum;
}

/// Share of directions from `from` that pass through the tetrahedron's face opposite it.
double gamma_by_points(const Stages& s, int f, int k, int points) {
  const auto& facet = s.network.facet_vertices[f];
  const double r = s.spheres.radii[facet[k]];
  const Vector centre = s.spheres.centres.col(facet[k]);
  double sum = 0.0;
  const Vector u = s.spheres.towards(facet[k], facet[(k + 1) % 3]);
  const Vector v = s.spheres.towards(facet[k], facet[(k + 2) % 3]);
  const Vector normal = pfv::unit_normal(facet, s.spheres);
  for (int side = 0; side < 2; ++side) {
    const Vector p = s.network.cell_centres.col(s.network.facet_cells[f][side]) - centre;
    Eigen::Matrix3d cone;
    cone << u, v, p;
    if (std::abs(cone.determinant()) < 1e-14) continue;
    const Eigen::Matrix3d inverse = cone.inverse();
    int within = 0;
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector2d q = plane_sequence(i);
      const double z = 2.0 * q[0] - 1.0, phi = 2.0 * pi * q[1], w = std::sqrt(1.0 - z * z);
      const Vector direction(w * std::cos(phi), w * std::sin(phi), z);
      within += ((inverse * direction).array() >= 0.0).all();
    }
    const double height = (side ? 1.0 : -1.0) * normal.dot(p);
    sum += (height >= 0 ? 1.0 : -1.0) * 4.0 * pi * r * r * within / points;
  }
  return sum;
}

/// A^f: part of the polygon in no disc of the facet.
double fluid_area_by_points(const Stages& s, int f, int points) {
  const auto polygon = polygon_of(s, f);
  double area = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Vector u = polygon[i - 1] - polygon[0], v = polygon[i] - polygon[0];
    int free = 0;
    for (int j = 0; j < points; ++j) {
      Eigen::Vector2d q = plane_sequence(j);
      if (q[0] + q[1] > 1.0) q = Eigen::Vector2d::Ones() - q;
      const Vector x = polygon[0] + q[0] * u + q[1] * v;
      bool covered = false;
      for (const int k : s.network.facet_vertices[f])
        covered = covered || (!pfv::is_wall(k) && (x - s.spheres.centres.col(k)).squaredNorm() <
                                                      s.spheres.radii[k] * s.spheres.radii[k]);
      free += !covered;
    }
    area += 0.5 * u.cross(v).norm() * free / points;
  }
  return area;
}

bool is_obtuse(const Stages& s, const std::array<pfv::Vertex, 3>& facet) {
  for (int k = 0; k < 3; ++k)
    if (s.spheres.towards(facet[k], facet[(k + 1) % 3])
            .dot(s.spheres.towards(facet[k], facet[(k + 2) % 3])) < 0.0)
      return true;
  return false;
}

/// Some throats of each kind: inner, one wall, two walls, obtuse.
std::vector<int> throats_of_each_kind(const Stages& s, int each) {
  std::array<int, 4> found{};
  std::vector<int> throats;
  for (int t = 0; t < s.network.throats(); ++t) {
    if (s.network.throat_facets[t + 1] - s.network.throat_facets[t] != 1) continue;
    const auto& facet = s.network.facet_vertices[s.network.throat_facets[t]];
    int kind = 0;
    for (const int v : facet) kind += pfv::is_wall(v);
    if (kind == 0 && is_obtuse(s, facet)) kind = 3;
    if (found[kind]++ < each) throats.push_back(t);
  }
  for (const int n : found) EXPECT_GE(n, each);
  return throats;
}

constexpr int points = 40000;
constexpr double tolerance = 1e-3;  // error of the sequence with these points

TEST(SingleThroats, VolumeAndSurfaceAgreeWithQuadrature) {
  const Stages s = stages_of(random_packing(60, 0.06, 0.12, 31), [] {
    pfv::Box box;
    for (const pfv::Face face : pfv::all_faces) box[face].wall = pfv::Wall::symmetry;
    return box;
  }());
  for (const int t : throats_of_each_kind(s, 8)) {
    const int f = s.network.throat_facets[t];
    double whole = 0.0;
    for (const Pyramid& p : domain_of(s, f)) whole += volume_of(p);
    EXPECT_NEAR(s.throats.volume[t], phi_by_points(s, f, points), tolerance * whole);
    double gamma = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (pfv::is_wall(s.network.facet_vertices[f][k])) continue;
      const double r = s.spheres.radii[s.network.facet_vertices[f][k]];
      const double expected = gamma_by_points(s, f, k, points);
      EXPECT_NEAR(s.throats.facet_gamma[f][k], expected, tolerance * 4.0 * pi * r * r);
      gamma += s.throats.facet_gamma[f][k];
    }
    EXPECT_NEAR(s.throats.gamma[t], gamma, 1e-15);  // symmetry walls have no share
  }
}

TEST(SingleThroats, NoSlipWallsAddTheirTriangles) {
  const auto packing = random_packing(60, 0.06, 0.12, 31);
  const Stages rough = stages_of(packing, pfv::Box{});
  for (const int t : throats_of_each_kind(rough, 8)) {
    const int f = rough.network.throat_facets[t];
    const auto polygon = polygon_of(rough, f);
    for (int k = 0; k < 3; ++k) {
      const int v = rough.network.facet_vertices[f][k];
      if (!pfv::is_wall(v)) continue;
      const int face = pfv::wall_number(v);
      const double plane = face % 2 ? 1.0 : 0.0;
      std::vector<Vector> base;  // the polygon's side on this wall
      for (const Vector& corner : polygon)
        if (corner[face / 2] == plane) base.push_back(corner);
      ASSERT_EQ(base.size(), 2u);
      double area = 0.0;
      const Vector normal = pfv::unit_normal(rough.network.facet_vertices[f], rough.spheres);
      for (int side = 0; side < 2; ++side) {
        const Vector p = rough.network.cell_centres.col(rough.network.facet_cells[f][side]);
        const double height = (side ? 1.0 : -1.0) * normal.dot(p - polygon[0]);
        area += (height >= 0 ? 0.5 : -0.5) * (base[1] - base[0]).cross(p - base[0]).norm();
      }
      EXPECT_NEAR(rough.throats.facet_gamma[f][k], area, 1e-15);
    }
  }
}

TEST(SingleThroats, FluidAreaAgreesWithQuadratureOfOverlappingDiscs) {
  Random random(17);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 50; ++k)
    spheres.push_back({random(0.02, 0.98), random(0.02, 0.98), random(0.02, 0.98),
                       random(0.05, 0.15)});
  for (const auto& packing : {packing_of(spheres), data_packing("packing_100.csv")}) {
    const Stages s = stages_of(packing, pfv::Box{});
    int overlapping = 0;
    for (const int t : throats_of_each_kind(s, 12)) {
      const int f = s.network.throat_facets[t];
      const double expected = fluid_area_by_points(s, f, points);
      EXPECT_NEAR(s.throats.fluid_area[t], expected, tolerance * s.throats.area[t]);
      overlapping += expected < 0.1 * s.throats.area[t];
    }
    EXPECT_GT(overlapping, 0);
  }
}

}  // namespace
}  // namespace throats_test
