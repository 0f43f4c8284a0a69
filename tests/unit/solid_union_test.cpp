// SPDX-License-Identifier: GPL-3.0-or-later
// Volume and surface of the union of the spheres inside the box, against formulas.
#include "physics/solid_union.hpp"

#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

namespace solid_union_test {
namespace {

using namespace support;

pfv::SolidUnion union_in(const pfv::PackingArrays& packing) {
  const Stages s = stages_of(packing, pfv::Box{});
  return pfv::solid_union(s.network, s.spheres, s.spheres);
}
pfv::SolidUnion union_of(const std::vector<Sphere>& spheres) {
  return union_in(packing_of(spheres));
}

double ball(double r) { return 4.0 / 3.0 * pi * r * r * r; }
double sphere(double r) { return 4.0 * pi * r * r; }
double cap_volume(double r, double h) { return pi * h * h * (3.0 * r - h) / 3.0; }
double cap_area(double r, double h) { return 2.0 * pi * r * h; }

struct Lens {
  double volume, area;  ///< common volume; surface of both within it
};
Lens lens(double r1, double r2, double d) {
  const double x = (d * d + r1 * r1 - r2 * r2) / (2.0 * d);
  const double h1 = r1 - x, h2 = r2 - (d - x);
  return {cap_volume(r1, h1) + cap_volume(r2, h2), cap_area(r1, h1) + cap_area(r2, h2)};
}

void expect(const pfv::SolidUnion& solid, double volume, double area) {
  EXPECT_NEAR(solid.volume / volume, 1.0, 1e-12);
  EXPECT_NEAR(solid.area / area, 1.0, 1e-12);
}

TEST(SolidUnion, OfSeparateSpheresIsTheirSum) {
  const auto packing = random_packing(300, 0.02, 0.06, 5);
  expect(union_in(packing), solid_volume(packing), solid_surface(packing));
}

TEST(SolidUnion, OfTwoSpheresIsTheirSumLessTheLens) {
  for (const double d : {0.199, 0.15, 0.1, 0.05, 0.01}) {
    const Lens common = lens(0.1, 0.1, d);
    expect(union_of({{0.5, 0.5, 0.5, 0.1}, {0.5 + d, 0.5, 0.5, 0.1}}),
           2 * ball(0.1) - common.volume, 2 * sphere(0.1) - common.area);
  }
}

// The small sphere's centre lies in the big one's power cell once d² < R² - r².
TEST(SolidUnion, HoldsWhereACentreLiesOutsideItsOwnPowerCell) {
  const double big = 0.2, small = 0.1;
  for (const double d : {0.29, 0.2, 0.18, 0.15, 0.11}) {
    const Lens common = lens(big, small, d);
    expect(union_of({{0.5, 0.5, 0.5, big}, {0.5, 0.5 + d, 0.5, small}}),
           ball(big) + ball(small) - common.volume,
           sphere(big) + sphere(small) - common.area);
  }
}

// Centre exactly on the radical plane (3-4-5), along an oblique line: rounding may put it on either
// side in each cell.
TEST(SolidUnion, HoldsWhereACentreLiesOnItsRadicalPlane) {
  const double small = 0.15, big = 0.25, d = 0.2;
  const Lens common = lens(big, small, d);
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d x =
        Eigen::Vector3d::Constant(0.5) + d * random.in_cube().normalized();
    expect(union_of({{0.5, 0.5, 0.5, big}, {x[0], x[1], x[2], small}}),
           ball(big) + ball(small) - common.volume,
           sphere(big) + sphere(small) - common.area);
  }
}

// And one that lies on the line of two such planes.
TEST(SolidUnion, IsFiniteWhereACentreLiesOnTwoRadicalPlanes) {
  const double small = 0.15, big = 0.25, d = 0.2;
  const pfv::SolidUnion solid = union_of(
      {{0.5, 0.5, 0.5, small}, {0.5 + d, 0.5, 0.5, big}, {0.5, 0.5 + d, 0.5, big}});
  EXPECT_GT(solid.volume, ball(big));
  EXPECT_LT(solid.volume, 2 * ball(big) + ball(small));
  EXPECT_GT(solid.area, sphere(big));
}

TEST(SolidUnion, OfAChainIsItsSpheresLessTheLenses) {
  std::vector<Sphere> chain;
  const double r = 0.08, d = 0.11;
  for (int i = 0; i < 7; ++i) chain.push_back({0.15 + d * i, 0.5, 0.5, r});
  const Lens common = lens(r, r, d);
  expect(union_of(chain), 7 * ball(r) - 6 * common.volume, 7 * sphere(r) - 6 * common.area);
}

TEST(SolidUnion, LeavesOutTheCapBeyondAFace) {
  const double r = 0.2, x = 0.12;
  expect(union_of({{x, 0.5, 0.5, r}}), ball(r) - cap_volume(r, r - x),
         sphere(r) - cap_area(r, r - x));
}

TEST(SolidUnion, LeavesOutWhatLiesBeyondAnEdgeOrACorner) {
  // by symmetry: a centre almost on an edge leaves a quarter, in a corner an eighth
  const double r = 0.3, hair = 1e-15;
  expect(union_of({{hair, hair, 0.5, r}}), ball(r) / 4, sphere(r) / 4);
  expect(union_of({{hair, 1 - hair, hair, r}}), ball(r) / 8, sphere(r) / 8);
  expect(union_of({{hair, 0.5, 0.5, r}}), ball(r) / 2, sphere(r) / 2);
}

/// Part of the ball of radius r about the origin where x > -a and y > -b, by midpoints in z and x.
double ball_in_wedge(double r, double a, double b) {
  const int n = 4000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double t = pi * ((i + 0.5) / n - 0.5), rho = r * std::cos(t);
    double slice = 0.0;
    const int m = 400;
    for (int j = 0; j < m; ++j) {
      const double s = pi * ((j + 0.5) / m - 0.5), x = rho * std::sin(s);
      if (x < -a) continue;
      slice += (rho * std::cos(s) + std::min(rho * std::cos(s), b)) * rho * std::cos(s);
    }
    sum += slice * pi / m * r * std::cos(t);
  }
  return sum * pi / n;
}

TEST(SolidUnion, LeavesOutWhatLiesBeyondTwoFaces) {
  const double r = 0.3, a = 0.1, b = 0.15;
  const pfv::SolidUnion solid = union_of({{a, b, 0.5, r}});
  EXPECT_NEAR(solid.volume / ball_in_wedge(r, a, b), 1.0, 2e-3);  // the quadrature's error
}

TEST(SolidUnion, DoesNotCountAHiddenSphere) {
  const Stages s = stages_of(
      packing_of({{0.5, 0.5, 0.5, 0.3}, {0.55, 0.5, 0.5, 0.1}, {0.1, 0.1, 0.1, 0.05}}),
      pfv::Box{});
  EXPECT_EQ(s.network.hidden, std::vector<int>{1});
  expect(pfv::solid_union(s.network, s.spheres, s.spheres), ball(0.3) + ball(0.05),
         sphere(0.3) + sphere(0.05));
}

/// Share of the box that spheres cover, by points of a randomised lattice rule.
double covered(const pfv::PackingArrays& packing, int points) {
  // Korobov lattice: error about 1/points for smooth, 1e-3 or better for solids
  int inside = 0;
  Eigen::Vector3d x(0.37, 0.11, 0.83);
  const Eigen::Vector3d step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  for (int i = 0; i < points; ++i) {
    x = (x + step).unaryExpr([](double v) { return v - std::floor(v); });
    for (int k = 0; k < packing.radii.size(); ++k)
      if ((packing.positions.col(k) - x).squaredNorm() < packing.radii[k] * packing.radii[k]) {
        ++inside;
        break;
      }
  }
  return static_cast<double>(inside) / points;
}

TEST(SolidUnion, OfRandomOverlappingSpheresAgreesWithMonteCarlo) {
  Random random(12);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 60; ++k)
    spheres.push_back({random(0.01, 0.99), random(0.01, 0.99), random(0.01, 0.99),
                       random(0.05, 0.25)});
  const auto packing = packing_of(spheres);
  EXPECT_NEAR(union_in(packing).volume, covered(packing, 1000000), 2e-3);
  EXPECT_NEAR(union_in(data_packing("packing_100.csv")).volume,
              covered(data_packing("packing_100.csv"), 400000), 2e-3);
}

// d(volume)/d(all radii) is the surface: ties area to volume wherever there is no formula.
TEST(SolidUnion, AreaIsTheDerivativeOfTheVolumeByTheRadii) {
  const auto at = [](double grown) {
    pfv::PackingArrays packing = data_packing("packing_100.csv");
    packing.radii.array() += grown;
    return union_in(packing);
  };
  const double h = 1e-5;
  EXPECT_NEAR((at(h).volume - at(-h).volume) / (2.0 * h) / at(0.0).area, 1.0, 1e-8);
}

}  // namespace
}  // namespace solid_union_test
