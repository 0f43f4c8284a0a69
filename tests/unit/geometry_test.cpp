// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of discs, balls and solid angles against known cases and quadrature.
#include "geometry/ball_sections.hpp"
#include "geometry/disc_sections.hpp"
#include "geometry/solid_angle.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace geometry_test {
namespace {

using pfv::Polygon;
using support::pi;
using support::Random;

Polygon polygon(const std::vector<Eigen::Vector2d>& corners) {
  Polygon result;
  for (const auto& corner : corners) result.add(corner);
  return result;
}
Polygon square(double x0, double x1, double y0, double y1) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}
double area_in_disc(const Polygon& p, double radius) { return pfv::section_in_disc(p, radius).area; }
double area(const Polygon& p) { return area_in_disc(p, 1e3); }

TEST(AreaInDisc, KnownCases) {
  EXPECT_NEAR(area_in_disc(square(-2, 2, -2, 2), 1.0), pi, 1e-15);        // disc inside
  EXPECT_NEAR(area_in_disc(square(-.5, .5, -.5, .5), 1.0), 1.0, 1e-15);   // square inside
  EXPECT_NEAR(area_in_disc(square(0, 2, -2, 2), 1.0), pi / 2, 1e-15);     // half
  EXPECT_NEAR(area_in_disc(square(0, 2, 0, 2), 1.0), pi / 4, 1e-15);      // corner
  EXPECT_EQ(area_in_disc(square(2, 3, 2, 3), 1.0), 0.0);                  // apart
  const double segment = std::acos(0.5) - 0.5 * std::sqrt(0.75);
  EXPECT_NEAR(area_in_disc(square(0.5, 2, -2, 2), 1.0), segment, 1e-15);
  EXPECT_NEAR(area_in_disc(square(-0.5, 0.5, -2, 2), 1.0), pi - 2 * segment, 1e-15);
}

TEST(AreaInDisc, TangentsAndEmptyPolygonsTakeNothing) {
  EXPECT_NEAR(area_in_disc(square(1, 2, -2, 2), 1.0), 0.0, 1e-15);
  EXPECT_EQ(area_in_disc(Polygon{}, 1.0), 0.0);
  EXPECT_EQ(area_in_disc(polygon({{0, 0}, {1, 0}, {0.5, 0}}), 1.0), 0.0);
}

/// Area of a convex polygon (counterclockwise) in a disc by midpoint columns of exact height.
double by_columns(const Polygon& p, double radius, int columns) {
  double sum = 0.0;
  for (int i = 0; i < columns; ++i) {
    // x = r sin t: the height is smooth in t up to the circle's ends
    const double t = pi * ((i + 0.5) / columns - 0.5), x = radius * std::sin(t);
    double low = -radius * std::cos(t), high = -low;
    for (int c = 0; c < p.size; ++c) {
      const Eigen::Vector2d a = p.corners[c], edge = p.corners[(c + 1) % p.size] - a;
      if (edge.x() == 0.0) {
        if (edge.y() * (x - a.x()) > 0.0) high = low;
        continue;
      }
      const double y = a.y() + edge.y() / edge.x() * (x - a.x());
      if (edge.x() > 0.0) low = std::max(low, y);
      if (edge.x() < 0.0) high = std::min(high, y);
    }
    sum += std::max(0.0, high - low) * radius * std::cos(t);
  }
  return sum * pi / columns;
}

TEST(AreaInDisc, AgreesWithQuadratureForRandomTriangles) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    Polygon p;
    for (int c = 0; c < 3; ++c) p.add({random(-1.5, 1.5), random(-1.5, 1.5)});
    const Eigen::Vector2d u = p.corners[1] - p.corners[0], v = p.corners[2] - p.corners[0];
    if (u.x() * v.y() < u.y() * v.x()) std::swap(p.corners[1], p.corners[2]);
    // the height's jump at an upright side costs one column: 1e-6 with 1e5
    EXPECT_NEAR(area_in_disc(p, 1.0), by_columns(p, 1.0, 100000), 1e-7);
  }
}

TEST(Clip, CutsHalfPlanes) {
  const Polygon box = square(0, 1, 0, 1);
  EXPECT_NEAR(area(pfv::clip(box, {1, 0}, 0.25)), 0.25, 1e-15);
  EXPECT_NEAR(area(pfv::clip(box, {1, 1}, 1.0)), 0.5, 1e-15);   // through two corners
  EXPECT_NEAR(area(pfv::clip(box, {2, 2}, 3.0)), 0.875, 1e-15); // a corner off
  EXPECT_EQ(pfv::clip(box, {1, 0}, -0.5).size, 0);
  EXPECT_EQ(pfv::clip(box, {1, 0}, 2.0).size, 4);
}

TEST(Clip, LeavesThePartsOfAPolygonThatAddUp) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Polygon box = square(-1, random(0, 1), -1, random(0, 1));
    const Eigen::Vector2d normal(random(-1, 1), random(-1, 1));
    const double offset = random(-0.5, 0.5);
    EXPECT_NEAR(area(pfv::clip(box, normal, offset)) + area(pfv::clip(box, -normal, -offset)),
                area(box), 1e-14);
  }
}

/// Ball beyond the plane within the orthoscheme's cone, by quadrature over the plane's triangle in
/// polar coordinates about the foot of the perpendicular: exact in the polar distance.
pfv::BallSection by_polar_angle(double r, double a, double b, double c, int steps) {
  pfv::BallSection sum;
  const double end = std::atan2(c, b);
  for (int i = 0; i < steps; ++i) {
    const double phi = end * (i + 0.5) / steps;
    const double reach = std::min(b / std::cos(phi), std::sqrt(r * r - a * a));
    const double cosine = a / std::hypot(a, reach);  // of the widest polar angle
    sum.area += r * r * (1.0 - cosine);
    sum.volume += r * r * r / 3.0 * (1.0 - cosine) - a * reach * reach / 6.0;
  }
  sum.area *= end / steps;
  sum.volume *= end / steps;
  return sum;
}

TEST(BeyondPlane, AgreesWithQuadrature) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const double a = random(0.01, 0.99), b = random(0.0, 1.2), c = random(0.0, 1.5);
    const pfv::BallSection exact = pfv::beyond_plane(1.0, a, b, c);
    const pfv::BallSection sum = by_polar_angle(1.0, a, b, c, 2000);
    EXPECT_NEAR(exact.volume, sum.volume, 1e-6);  // a kink: second order
    EXPECT_NEAR(exact.area, sum.area, 1e-6);
  }
}

TEST(BeyondPlane, KnownCases) {
  // far corners: an eighth of the plane is seen under phi = pi/4: an eighth of the cap
  const double h = 1.0 - 0.4;
  const pfv::BallSection cap = pfv::beyond_plane(1.0, 0.4, 10.0, 10.0);
  EXPECT_NEAR(8.0 * cap.volume, pi * h * h * (3.0 - h) / 3.0, 1e-14);
  EXPECT_NEAR(8.0 * cap.area, 2.0 * pi * h, 1e-14);
  // a plane through the centre leaves half a ball
  EXPECT_NEAR(8.0 * pfv::beyond_plane(1.0, 0.0, 10.0, 10.0).volume, 2.0 * pi / 3.0, 1e-14);
  // plane and scheme within the ball: cone of the ball less the orthoscheme a b c / 6
  const double a = 0.3, b = 0.2, c = 0.1;
  const double angle = pfv::solid_angle({a, 0, 0}, {a, b, 0}, {a, b, c});
  EXPECT_NEAR(pfv::beyond_plane(1.0, a, b, c).volume, angle / 3.0 - a * b * c / 6.0, 1e-15);
  EXPECT_NEAR(pfv::beyond_plane(1.0, a, b, c).area, angle, 1e-15);
}

TEST(BeyondPlane, IsZeroOutsideTheBallAndForFlatSchemes) {
  EXPECT_EQ(pfv::beyond_plane(1.0, 1.0, 1.0, 1.0).volume, 0.0);
  EXPECT_EQ(pfv::beyond_plane(1.0, 2.0, 1.0, 1.0).area, 0.0);
  EXPECT_EQ(pfv::beyond_plane(1.0, 0.5, 0.5, 0.0).volume, 0.0);
  EXPECT_EQ(pfv::beyond_plane(1.0, 0.5, 0.0, 0.5).volume, 0.0);
  EXPECT_EQ(pfv::beyond_plane(1.0, 0.0, 0.0, 0.5).volume, 0.0);  // centre on the scheme's edge
  EXPECT_EQ(pfv::beyond_plane(1.0, 0.0, 0.0, 0.5).area, 0.0);
}

TEST(SolidAngle, KnownCases) {
  const Eigen::Vector3d x(1, 0, 0), y(0, 2, 0), z(0, 0, 3);
  EXPECT_NEAR(pfv::solid_angle(x, y, z), pi / 2, 1e-15);   // an octant
  EXPECT_NEAR(pfv::solid_angle(y, x, z), -pi / 2, 1e-15);  // seen from behind
  EXPECT_NEAR(pfv::solid_angle(x, y, {1, 1, 0}), 0.0, 1e-15);  // flat
  // the face of a regular tetrahedron seen from its middle: a quarter of the sphere
  EXPECT_NEAR(pfv::solid_angle({1, 1, 1}, {-1, -1, 1}, {1, -1, -1}), pi, 1e-14);
  // half of a face of the cube around it
  EXPECT_NEAR(pfv::solid_angle({1, -1, -1}, {1, 1, -1}, {1, 1, 1}), pi / 3, 1e-15);
}

TEST(SolidAngle, OfATetrahedronSurroundingThePlaceIsFourPi) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    std::array<Eigen::Vector3d, 4> v;
    for (auto& corner : v) corner = random.in_cube();
    const double sum = pfv::solid_angle(v[1], v[2], v[3]) - pfv::solid_angle(v[0], v[2], v[3]) +
                       pfv::solid_angle(v[0], v[1], v[3]) - pfv::solid_angle(v[0], v[1], v[2]);
    const double turns = sum / (4.0 * pi);  // 0 outside, +-1 inside
    EXPECT_NEAR(turns, std::round(turns), 1e-13);
  }
}

}  // namespace
}  // namespace geometry_test
