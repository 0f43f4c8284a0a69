// SPDX-License-Identifier: GPL-3.0-or-later
// The open-throat law beside Stokes flow: the nine-sphere cell and 36 spheres at random (finite
// elements, not fitted), cubic arrays (Zick & Homsy 1982 and finite elements; two numbers of the
// law were fitted on their loosened states), and beside the papers' law in dense beds.
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

namespace open_throat_test {
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
    EXPECT_NEAR(ratio, 1.0, 0.055) << "d/D " << row.at("d_over_D");
  }
  EXPECT_EQ(i, recorded.size());
}

// Goal: within 10 % at all d/D with both walls. Measured: within 3.1 and 5.4 %.
TEST(OpenThroat, NineSpheresBetweenSymmetryWalls) {
  expect_nine_spheres("symmetry", {0.9790, 0.9695, 0.9708, 0.9712, 0.9807, 0.9796});
}
TEST(OpenThroat, NineSpheresBetweenNoSlipWalls) {
  expect_nine_spheres("no_slip", {0.9667, 0.9466, 0.9490, 0.9471, 0.9652, 0.9593});
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
TEST(OpenThroat, RandomBedsOf36SpheresAreWithin3PerCentOfStokesFlow) {
  const std::vector<double> recorded{0.9723, 1.0159, 0.9705, 1.0055};
  std::size_t i = 0;
  for (const Row& row : table("stokes_36_permeability.csv")) {
    const double ratio =
        permeability(data_packing(row.at("packing")), wall_named(row.at("wall"))) /
        number(row, "permeability");
    EXPECT_NEAR(ratio, recorded.at(i++), 1e-4) << row.at("packing") << ", " << row.at("wall");
    EXPECT_NEAR(ratio, 1.0, 0.03) << row.at("packing") << ", " << row.at("wall");
  }
  EXPECT_EQ(i, recorded.size());
}

// Eight spheres between symmetry walls are a simple cubic array; k = L³ / (6 pi a K), L = 1/2.
TEST(OpenThroat, SimpleCubicArrayFromTouchingToDilute) {
  // radius scale, drag factor, recorded k / k_exact
  const std::vector<std::array<double, 3>> states{{1.0, 42.1, 0.9790},
                                                  {0.95, 27.9, 0.9540},
                                                  {0.9, 19.18, 0.9783},
                                                  {0.8, 10.06, 0.9964},
                                                  {0.5, 2.84202, 1.0431},
                                                  {0.1, 1.16461, 1.0379}};
  for (const auto& [scale, drag, recorded] : states) {
    pfv::PackingArrays packing = nine_spheres(0.0);
    packing.radii *= scale;
    const double exact = 0.125 / (6.0 * pi * 0.25 * scale * drag);
    EXPECT_NEAR(permeability(packing, pfv::Wall::symmetry) / exact, recorded, 1e-3) << scale;
  }
}

struct LatticeState {
  double scale;
  double exact;  ///< k / L², L the cell's edge
  double recorded;
};

double k_of_drag(int spheres, double radius, double drag) {
  return 1.0 / (6.0 * pi * spheres * radius * drag);
}

void expect_lattice(Lattice kind, const std::vector<LatticeState>& states) {
  for (const LatticeState& state : states) {
    pfv::Box cell;
    cell.periodic = {true, true, true};
    pfv::Flow flow(cell, viscosity_one());
    flow.evaluate(lattice(kind, 1, state.scale).view());
    const Eigen::Matrix3d k = *flow.report().permeability_tensor / state.exact;
    EXPECT_NEAR(k(0, 0), state.recorded, 1e-4) << state.scale;
    EXPECT_LT((k - k(0, 0) * Eigen::Matrix3d::Identity()).norm(), 1e-12) << state.scale;
    EXPECT_NEAR(k(0, 0), 1.0, 0.083) << state.scale;
  }
}

// Goal: within 10 % at radius scales 1, 0.95, 0.9 and 0.8. Zick & Homsy (1982) where touching,
// finite elements (0.2 %) where loosened; where overlapping by 3 and 6 % finite elements (1 %), the
// papers' law is 22 to 40 % low. Measured: within 7.9 % touching, 4.6 % loosened, 8.3 %
// overlapping.
TEST(OpenThroat, PeriodicSimpleCubicArray) {
  const auto k = [](double scale, double drag) { return k_of_drag(1, 0.5 * scale, drag); };
  expect_lattice(Lattice::sc, {{1.06, 1.37346e-3, 0.9172},
                               {1.03, 1.87691e-3, 0.9406},
                               {1.0, k(1.0, 42.1), 0.9790},
                               {0.95, k(0.95, 27.9), 0.9540},
                               {0.9, k(0.9, 19.18), 0.9783},
                               {0.8, k(0.8, 10.06), 0.9964}});
}
TEST(OpenThroat, PeriodicBodyCentredArray) {
  const auto k = [](double scale, double drag) {
    return k_of_drag(2, std::sqrt(3.0) / 4.0 * scale, drag);
  };
  expect_lattice(Lattice::bcc, {{1.03, 2.19335e-4, 1.0049},
                                {1.0, k(1.0, 162.9), 1.0225},
                                {0.95, k(0.95, 78.6), 1.0063},
                                {0.9, k(0.9, 42.82), 1.0102},
                                {0.8, k(0.8, 16.86), 1.0014},
                                {0.7, k(0.7, 8.57), 1.0065}});
}
TEST(OpenThroat, PeriodicFaceCentredArray) {
  const auto k = [](double scale, double drag) {
    return k_of_drag(4, std::sqrt(2.0) / 4.0 * scale, drag);
  };
  expect_lattice(Lattice::fcc, {{1.0, k(1.0, 435.0), 0.9209},
                                {0.95, k(0.95, 147.9), 1.0377},
                                {0.9, k(0.9, 65.2), 1.0217},
                                {0.8, k(0.8, 20.90), 0.9837},
                                {0.7, k(0.7, 9.72), 0.9842}});
}

// Spheres that cross symmetry walls overlap with their images, but of the caps there only 0.8
// counts: with all of them, as in the periodic cell, the law would be 7 % above the papers' in
// packing_500.
TEST(OpenThroat, OverlappingSimpleCubicArrayBetweenSymmetryWalls) {
  const std::vector<std::array<double, 3>> states{{1.03, 1.87691e-3, 0.9221},
                                                  {1.06, 1.37346e-3, 0.8774}};
  for (const auto& [scale, exact, recorded] : states) {
    pfv::PackingArrays packing = nine_spheres(0.0);
    packing.radii *= scale;
    EXPECT_NEAR(permeability(packing, pfv::Wall::symmetry) / (0.25 * exact), recorded, 1e-4)
        << scale;
  }
}

// Dense beds with the overlaps of a discrete-element run: both laws agree to 5 %. For packing_100 a
// finite-element solution on a coarse mesh gives K 8.18e-5, the law 8.29e-5, the papers' 8.39e-5.
TEST(OpenThroat, DenseBedsAgreeWithTheHydraulicRadiusWithin5PerCent) {
  const std::vector<std::pair<const char*, double>> beds{{"packing_100.csv", 0.9873},
                                                         {"packing_500.csv", 1.0482}};
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
}  // namespace open_throat_test
