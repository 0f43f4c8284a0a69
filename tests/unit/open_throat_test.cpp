// SPDX-License-Identifier: GPL-3.0-or-later
// The open-throat law term by term, its limits and its bounds.
#include "physics/conductances.hpp"
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace open_throat_test {
namespace {

using namespace support;
using pfv::ConductanceLaw;

pfv::Conductances law(const Stages& s, ConductanceLaw which = ConductanceLaw::open_throat) {
  return pfv::conductances(which, 1.0, s.network, s.throats, s.spheres);
}

/// The throat whose first facet has these vertices.
int throat_with(const Stages& s, const std::array<int, 3>& vertices) {
  for (int t = 0; t < s.network.throats(); ++t) {
    const auto& facet = s.network.facet_vertices[s.network.throat_facets[t]];
    if (std::is_permutation(facet.begin(), facet.end(), vertices.begin())) return t;
  }
  ADD_FAILURE() << "no such facet";
  return 0;
}

double openness(double gap) {
  const double ratio = gap / 0.18 * std::pow((gap + 0.001) / 0.18, -0.2);
  return ratio / (1.0 + ratio);
}

double kuwabara(double c) {
  const double s = std::cbrt(c);
  const double drag = 5.0 / (5.0 - 9.0 * s + 5.0 * c - c * c);
  return std::pow(1.0 - c, 3) * drag / (2.0 * c);
}

// Three spheres, none touching, free of the walls: 1/g = 1/g_touching + w/g_open term by term.
TEST(OpenThroat, IsTwoResistancesInSeries) {
  const Stages s = stages_of(
      packing_of({{0.35, 0.4, 0.5, 0.1}, {0.65, 0.4, 0.5, 0.12}, {0.48, 0.7, 0.52, 0.14}}),
      upward_box(pfv::Wall::symmetry));
  const int t = throat_with(s, {0, 1, 2});
  const double radius = s.throats.volume[t] / s.throats.gamma[t];
  const double whole = s.throats.area[t] * s.throats.length[t] / 3.0;
  const double porosity = s.throats.volume[t] / whole;
  std::array<double, 3> w{};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double distance = (s.spheres.centres.col(i) - s.spheres.centres.col(j)).norm();
    w[i] = openness(distance / (s.spheres.radii[i] + s.spheres.radii[j]) - 1.0);
  }
  std::sort(w.begin(), w.end());
  const double touching = 0.5 * s.throats.fluid_area[t] * radius * radius;
  const double open =
      s.throats.area[t] * porosity * radius * radius / kuwabara(1.0 - porosity);
  const double expected = 1.0 / (1.0 / touching + 0.5 * (w[0] + w[1]) / open);
  EXPECT_NEAR(law(s).value[t] * s.throats.length[t] / expected, 1.0, 1e-12);
}

// One sphere in the middle, facets between it and two walls: the gaps at the walls count as sides,
// all of them where walls mirror, half of them where walls are sides themselves.
TEST(OpenThroat, KnowsTheTwoKindsOfWall) {
  const double r = 0.3, w = openness(0.5 / r - 1.0);
  for (const pfv::Wall wall : {pfv::Wall::symmetry, pfv::Wall::no_slip}) {
    const bool sticks = wall == pfv::Wall::no_slip;
    const Stages s = stages_of(packing_of({{0.5, 0.5, 0.5, r}}), upward_box(wall));
    const int t = throat_with(s, {0, pfv::wall_vertex(0), pfv::wall_vertex(2)});
    double spheres = 0.0, walls = 0.0;
    for (int f = s.network.throat_facets[t]; f < s.network.throat_facets[t + 1]; ++f)
      for (int i = 0; i < 3; ++i)
        (pfv::is_wall(s.network.facet_vertices[f][i]) ? walls : spheres) +=
            s.throats.facet_gamma[f][i];
    EXPECT_EQ(walls > 0.0, sticks);
    walls *= 2.0 / 3.0;
    const double area = s.throats.area[t], gamma = spheres + walls;
    const double radius = s.throats.volume[t] / gamma;
    const double porosity = s.throats.volume[t] / (area * s.throats.length[t] / 3.0);
    const double root =
        (spheres * std::sqrt(kuwabara(1.0 - porosity)) + walls * std::sqrt(3.0)) / gamma;
    const double touching = 0.5 * s.throats.fluid_area[t] * radius * radius;
    const double open = area * porosity * radius * radius / (root * root);
    const double expected = 1.0 / (1.0 / touching + (sticks ? 0.5 : 1.0) * w / open);
    EXPECT_NEAR(law(s).value[t] * s.throats.length[t] / expected, 1.0, 1e-12);
  }
}

TEST(OpenThroat, IsTheHydraulicRadiusWhereSpheresAndSlipWallsTouch) {
  const Stages s = stages_of(nine_spheres(0.0), upward_box(pfv::Wall::symmetry));
  const auto open = law(s), papers = law(s, ConductanceLaw::hydraulic_radius);
  for (int t = 0; t < s.network.throats(); ++t)
    EXPECT_NEAR(open.value[t] / papers.value[t], 1.0, 1e-7);  // gaps of rounding: w of 1e-15 / 0.18
}

// Stokes: a sphere of radius a in each cell of edge L lets k = L³ / (6 pi a) through, 1 - 1.76
// c^(1/3) times that. The drag takes over slowly: measured 3.8, 2.2 and 1.2 % more than that.
TEST(OpenThroat, IsStokesDragOnSpheresFarApart) {
  double largest = 0.038;
  for (const double a : {0.05, 0.025, 0.0125}) {
    pfv::Options options;
    options.conductance = ConductanceLaw::open_throat;
    pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one(), options);
    flow.evaluate(packing_of({{0.5, 0.5, 0.5, a}}).view());
    const double c = 4.0 / 3.0 * pi * a * a * a;
    const double exact = (1.0 - 1.7601 * std::cbrt(c) + c) / (6.0 * pi * a);
    EXPECT_NEAR(*flow.report().permeability / exact, 1.0, largest) << a;
    largest *= 0.6;
  }
}

// Overlaps hide surface, shared among the throats around a contact by their angles there: all of it
// between spheres, 0.8 of it at walls.
TEST(OpenThroat, OverlapsMakeItMorePermeableThanTheFullSpheresSurfaceWould) {
  pfv::PackingArrays packing = nine_spheres(0.0);
  packing.radii *= 1.03;
  const Stages s = stages_of(packing, upward_box(pfv::Wall::symmetry));
  const auto open = law(s), papers = law(s, ConductanceLaw::hydraulic_radius);
  const double r = 0.2575, h = r - 0.25;
  const double ball = 4.0 * pi * r * r;
  const double fluid = 0.125 - ball * r / 3.0;
  const auto growth = [&](double caps) {  // of R², where so many of a sphere's six caps count
    const double area = caps * 2.0 * pi * r * h;
    const double lens = caps * pi * h * h * (3.0 * r - h) / 3.0;
    return std::pow((1.0 + lens / fluid) / (1.0 - area / ball), 2);
  };
  // by the walls in the throat's facets: none, one (half of the sides end there), two
  const std::array<double, 3> expected{growth(6.0), growth(0.9 * 6.0), growth(0.8 * 6.0)};
  std::array<int, 3> found{};
  for (int t = 0; t < s.network.throats(); ++t) {
    const auto& facet = s.network.facet_vertices[s.network.throat_facets[t]];
    const auto walls = std::count_if(facet.begin(), facet.end(), pfv::is_wall);
    EXPECT_NEAR(open.value[t] / papers.value[t], expected[walls], 1e-10);
    ++found[walls];
  }
  for (const int throats : found) EXPECT_GT(throats, 0);
}

// Anything that geometry can offer gives a finite conductance of the order of S², never negative.
TEST(OpenThroat, IsBoundedForTinySpheresAndOverlappingOnes) {
  Random random(11);
  for (const double r : {1e-7, 1e-5, 1e-3, 0.05, 0.3})
    for (const pfv::Wall wall : {pfv::Wall::symmetry, pfv::Wall::no_slip}) {
      std::vector<Sphere> spheres;
      for (int k = 0; k < 12; ++k) {
        const Eigen::Vector3d x = random.in_cube(0.05, 0.95);
        spheres.push_back({x[0], x[1], x[2], r * random(0.5, 1.0)});
      }
      const Stages s = stages_of(packing_of(spheres), upward_box(wall));
      const auto c = law(s);
      for (int t = 0; t < s.network.throats(); ++t) {
        EXPECT_TRUE(std::isfinite(c.value[t]) && c.value[t] >= 0.0);
        const double area = s.throats.area[t];
        // two slip walls mirror the facet into four
        EXPECT_LE(c.value[t] * s.throats.length[t], 4000.0 * area * area * (1.0 + 1e-12));
        if (s.throats.fluid_area[t] > 1e-9 * area && s.throats.volume[t] > 0.0 &&
            s.throats.gamma[t] > 0.0) {
          EXPECT_GT(c.value[t], 0.0);
        }
      }
    }
}

TEST(OpenThroat, ScalesWithViscosityAndSize) {
  const pfv::PackingArrays packing = random_packing(20, 0.05, 0.15, 5);
  const Stages s = stages_of(packing, upward_box(pfv::Wall::no_slip));
  const auto one = law(s);
  const auto thick =
      pfv::conductances(ConductanceLaw::open_throat, 7.0, s.network, s.throats, s.spheres);
  for (int t = 0; t < s.network.throats(); ++t)
    EXPECT_NEAR(thick.value[t] * 7.0, one.value[t], 1e-14 * one.value[t]);
  EXPECT_EQ(std::count(one.by_rule.begin(), one.by_rule.end(), 1), 0);
}

}  // namespace
}  // namespace open_throat_test
