// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the throats: hydraulic radius (Chareyre et al. 2012 eqs. 7-9), effective radius (eq. 10).
#include "physics/conductances.hpp"

#include "network/facets.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace conductances_test {
namespace {

using namespace support;
using pfv::ConductanceLaw;

TEST(HydraulicRadius, IsHalfAreaTimesRadiusSquaredOverViscosityAndLength) {
  const Stages s = stages_of(data_packing("packing_100.csv"), upward_box(pfv::Wall::no_slip));
  const double mu = 3.0;
  const auto c =
      pfv::conductances(ConductanceLaw::hydraulic_radius, mu, s.network, s.throats, s.spheres);
  EXPECT_EQ(std::count(c.by_rule.begin(), c.by_rule.end(), 1), 0);
  for (int t = 0; t < s.network.throats(); ++t) {
    const double radius = s.throats.volume[t] / s.throats.gamma[t];
    const double expected =
        0.5 * s.throats.fluid_area[t] * radius * radius / (mu * s.throats.length[t]);
    EXPECT_NEAR(c.value[t] / expected, 1.0, 1e-14);
  }
}

/// Radius of the inscribed circle that the law used for the throat whose facet has these vertices.
double inscribed_radius(const Stages& s, const std::vector<int>& vertices) {
  const auto c =
      pfv::conductances(ConductanceLaw::effective_radius, 1.0, s.network, s.throats, s.spheres);
  for (int t = 0; t < s.network.throats(); ++t) {
    auto facet = s.network.facet_vertices[s.network.throat_facets[t]];
    if (!std::is_permutation(facet.begin(), facet.end(), vertices.begin(), vertices.end()))
      continue;
    const double effective =
        std::pow(c.value[t] * s.throats.length[t] / (2.0 * pi), 0.25);  // g = 2 pi R^4 / mu
    return 4.0 * effective - std::sqrt(s.throats.fluid_area[t] / pi);
  }
  ADD_FAILURE() << "no such facet";
  return 0.0;
}

Stages three_spheres(const std::vector<Sphere>& spheres) {
  return stages_of(packing_of(spheres), pfv::Box{});
}

TEST(InscribedCircle, BetweenEqualSpheresOnAnEqualSidedTriangle) {
  const double a = 0.3, r = 0.1;
  const double height = a * std::sqrt(0.75);
  const Stages s = three_spheres(
      {{0.4, 0.4, 0.5, r}, {0.4 + a, 0.4, 0.5, r}, {0.4 + a / 2, 0.4 + height, 0.5, r}});
  EXPECT_NEAR(inscribed_radius(s, {0, 1, 2}), a / std::sqrt(3.0) - r, 1e-14);
}

// Descartes' circle theorem: curvatures k4 = k1 + k2 + k3 + 2 sqrt(k1 k2 + k2 k3 + k3 k1).
TEST(InscribedCircle, BetweenThreeTouchingCirclesIsDescartes) {
  // radii 1, 2, 3: centres on a 3-4-5 triangle, curvature of the fourth 23/6
  const double u = 0.1;
  const Stages s = three_spheres(
      {{0.3, 0.3, 0.5, u}, {0.3 + 3 * u, 0.3, 0.5, 2 * u}, {0.3, 0.3 + 4 * u, 0.5, 3 * u}});
  EXPECT_NEAR(inscribed_radius(s, {0, 1, 2}), 6.0 / 23.0 * u, 1e-14);
}

TEST(InscribedCircle, BetweenTwoSpheresAndAWall) {
  const double d = 0.5, h = 0.4, r = 0.15;
  const Stages s = three_spheres({{0.25, 0.5, h, r}, {0.25 + d, 0.5, h, r}});
  // (d/2)² + (h - s)² = (r + s)²
  EXPECT_NEAR(inscribed_radius(s, {0, 1, pfv::wall_vertex(4)}),
              (d * d / 4.0 + h * h - r * r) / (2.0 * (h + r)), 1e-14);
}

TEST(InscribedCircle, BetweenASphereAndTwoWalls) {
  const double h = 0.4, r = 0.15;
  const Stages s = three_spheres({{h, 0.5, h, r}});
  // sqrt(2) (h - s) = r + s
  EXPECT_NEAR(inscribed_radius(s, {0, pfv::wall_vertex(0), pfv::wall_vertex(4)}),
              (std::sqrt(2.0) * h - r) / (1.0 + std::sqrt(2.0)), 1e-14);
}

TEST(EffectiveRadius, TakesTheSmallestCircleOfAPolygon) {
  const Stages s = stages_of(lattice(Lattice::sc, 3), pfv::Box{});
  const auto c =
      pfv::conductances(ConductanceLaw::effective_radius, 1.0, s.network, s.throats, s.spheres);
  // the square of four touching spheres of radius 1/6, in two triangles: inscribed (sqrt 2 - 1) r
  const double r = 1.0 / 6.0;
  const double area = 4 * r * r - pi * r * r;
  const double radius = (std::sqrt(area / pi) + (std::sqrt(2.0) - 1.0) * r) / 4.0;
  int squares = 0;
  for (int t = 0; t < s.network.throats(); ++t) {
    if (std::abs(s.throats.area[t] - 4 * r * r) > 1e-12 || s.throats.length[t] < 1.9 * r) continue;
    EXPECT_NEAR(c.value[t] / (2.0 * pi * std::pow(radius, 4) / (2.0 * r)), 1.0, 1e-12);
    ++squares;
  }
  EXPECT_EQ(squares, 3 * 3 * 2 * 2);  // directions, layers of spheres, squares in a layer
}

// Discs that cover their facet close it; the throat is counted.
TEST(DegenerateThroats, AreClosedWhereDiscsCoverTheFacet) {
  const double a = 0.3, r = 0.18;  // circumradius 0.173
  const double height = a * std::sqrt(0.75);
  const Stages s = three_spheres(
      {{0.4, 0.4, 0.5, r}, {0.4 + a, 0.4, 0.5, r}, {0.4 + a / 2, 0.4 + height, 0.5, r}});
  const auto c =
      pfv::conductances(ConductanceLaw::hydraulic_radius, 1.0, s.network, s.throats, s.spheres);
  EXPECT_EQ(std::count(c.by_rule.begin(), c.by_rule.end(), 1), 1);
  EXPECT_EQ(std::count(c.value.begin(), c.value.end(), 0.0), 1);
}

// A sphere 1e4 times smaller than its pore leaves phi / gamma without bound; conductances 1e25
// apart could not be factored. R_h is held at 100 sqrt(S), where a throat resists nothing.
TEST(DegenerateThroats, OfTinySpheresHaveABoundedHydraulicRadius) {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].wall = pfv::Wall::symmetry;
  const Stages s = stages_of(packing_of({{0.4, 0.5, 0.45, 1e-5}, {0.7, 0.45, 0.6, 1e-5}}), box);
  const auto c =
      pfv::conductances(ConductanceLaw::hydraulic_radius, 1.0, s.network, s.throats, s.spheres);
  EXPECT_EQ(std::count(c.by_rule.begin(), c.by_rule.end(), 1), s.network.throats());
  for (int t = 0; t < s.network.throats(); ++t)
    EXPECT_NEAR(c.value[t] * s.throats.length[t] /
                    (0.5 * s.throats.fluid_area[t] * 1e4 * s.throats.area[t]),
                1.0, 1e-13);
}

}  // namespace
}  // namespace conductances_test
