// SPDX-License-Identifier: GPL-3.0-or-later
// The open-throat law beside Stokes flow: the nine-sphere cell and 36 spheres at random (finite
// elements, not fitted), cubic arrays (Zick & Homsy 1982 and finite elements; the law's one length
// was fitted on their loosened states), and beside the papers' law in dense beds.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace support;
using pfv::ConductanceLaw;

double permeability(const pfv::PackingArrays& packing, pfv::Wall wall,
                    ConductanceLaw law = ConductanceLaw::open_throat) {
  pfv::Options options;
  options.conductance = law;
  pfv::Flow flow(upward_box(wall), viscosity_one(), options);
  flow.evaluate(packing.view());
  return *flow.report().permeability;
}

pfv::Wall wall_named(const std::string& name) {
  return name == "symmetry" ? pfv::Wall::symmetry : pfv::Wall::no_slip;
}

void expect_nine_spheres(const std::string& wall, const std::vector<double>& recorded) {
  std::size_t i = 0;
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    if (row.at("wall") != wall) continue;
    const double ratio = permeability(nine_spheres(number(row, "d_over_D")), wall_named(wall)) /
                         number(row, "permeability");
    EXPECT_NEAR(ratio, recorded.at(i++), 1e-4) << "d/D " << row.at("d_over_D");
    EXPECT_NEAR(ratio, 1.0, 0.06) << "d/D " << row.at("d_over_D");
  }
  EXPECT_EQ(i, recorded.size());
}

// Goal: within 10 % at all d/D with both walls. Measured: within 3.4 and 6.0 %.
TEST(OpenThroat, NineSpheresBetweenSymmetryWalls) {
  expect_nine_spheres("symmetry", {0.9790, 0.9664, 0.9681, 0.9702, 0.9822, 0.9801});
}
TEST(OpenThroat, NineSpheresBetweenNoSlipWalls) {
  expect_nine_spheres("no_slip", {0.9667, 0.9402, 0.9433, 0.9450, 0.9690, 0.9607});
}

// At least as good as the papers' law where that is at its best, to two per cent.
TEST(OpenThroat, IsNotWorseThanTheHydraulicRadiusByMoreThan2PerCent) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    const pfv::PackingArrays packing = nine_spheres(number(row, "d_over_D"));
    const pfv::Wall wall = wall_named(row.at("wall"));
    const auto error = [&](ConductanceLaw law) {
      return std::abs(permeability(packing, wall, law) / number(row, "permeability") - 1.0);
    };
    EXPECT_LE(error(ConductanceLaw::open_throat), error(ConductanceLaw::hydraulic_radius) + 0.02)
        << "d/D " << row.at("d_over_D") << ", " << row.at("wall");
  }
}

// The papers' law is 1.26 to 2.75 times too permeable here.
TEST(OpenThroat, RandomBedsOf36SpheresAreWithin5PerCentOfStokesFlow) {
  const std::vector<double> recorded{0.9843, 1.0321, 0.9567, 0.9900};
  std::size_t i = 0;
  for (const Row& row : table("stokes_36_permeability.csv")) {
    const double ratio =
        permeability(data_packing(row.at("packing")), wall_named(row.at("wall"))) /
        number(row, "permeability");
    EXPECT_NEAR(ratio, recorded.at(i++), 1e-4) << row.at("packing") << ", " << row.at("wall");
    EXPECT_NEAR(ratio, 1.0, 0.05) << row.at("packing") << ", " << row.at("wall");
  }
  EXPECT_EQ(i, recorded.size());
}

// Eight spheres between symmetry walls are a simple cubic array; k = L³ / (6 pi a K), L = 1/2.
TEST(OpenThroat, SimpleCubicArrayFromTouchingToDilute) {
  // radius scale, drag factor, recorded k / k_exact
  const std::vector<std::array<double, 3>> states{{1.0, 42.1, 0.9790},
                                                  {0.95, 27.9, 1.0051},
                                                  {0.9, 19.18, 1.0029},
                                                  {0.8, 10.06, 0.9794},
                                                  {0.5, 2.84202, 0.9898},
                                                  {0.1, 1.16461, 1.0143}};
  for (const auto& [scale, drag, recorded] : states) {
    pfv::PackingArrays packing = nine_spheres(0.0);
    packing.radii *= scale;
    const double exact = 0.125 / (6.0 * pi * 0.25 * scale * drag);
    EXPECT_NEAR(permeability(packing, pfv::Wall::symmetry) / exact, recorded, 1e-3) << scale;
  }
}

// Finite elements with overlaps: simple cubic, radii 3 and 6 % beyond touching: k / L² 1.877e-3 and
// 1.373e-3. The papers' law, whose R_h counts the hidden caps, is 22 and 40 % low.
TEST(OpenThroat, OverlappingSimpleCubicArray) {
  const std::vector<std::array<double, 3>> states{{1.03, 1.877e-3, 0.9038},
                                                  {1.06, 1.373e-3, 0.8391}};
  for (const auto& [scale, exact, recorded] : states) {
    pfv::PackingArrays packing = nine_spheres(0.0);
    packing.radii *= scale;
    EXPECT_NEAR(permeability(packing, pfv::Wall::symmetry) / (0.25 * exact), recorded, 2e-3)
        << scale;
  }
}

// Dense beds with the overlaps of a discrete-element run: both laws agree to 5 %. For packing_100 a
// finite-element solution on a coarse mesh gives K 8.18e-5, the law 8.180e-5, the papers' 8.394e-5.
TEST(OpenThroat, DenseBedsAgreeWithTheHydraulicRadiusWithin5PerCent) {
  const std::vector<std::pair<const char*, double>> beds{{"packing_100.csv", 0.9746},
                                                         {"packing_500.csv", 1.0357}};
  for (const auto& [name, recorded] : beds) {
    const pfv::PackingArrays packing = data_packing(name);
    const double ratio =
        permeability(packing, pfv::Wall::symmetry) /
        permeability(packing, pfv::Wall::symmetry, ConductanceLaw::hydraulic_radius);
    EXPECT_NEAR(ratio, recorded, 1e-4) << name;
    EXPECT_NEAR(ratio, 1.0, 0.05) << name;
  }
}

}  // namespace
