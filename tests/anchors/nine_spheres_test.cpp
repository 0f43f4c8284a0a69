// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's eight- and nine-sphere cells (Chareyre et al. 2012, sec. 4.2, table 2) beside our own
// finite-element Stokes solutions (stokes_nine_spheres.csv: K 0.2 %, totals 0.1 %, viscous parts 1
// %).
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace nine_spheres_test {
namespace {

using namespace support;

struct Solution {
  pfv::Forces forces;
  pfv::Report report;
};

Solution solve(double d_over_D, pfv::Wall wall,
               pfv::ConductanceLaw law = pfv::ConductanceLaw::hydraulic_radius) {
  const pfv::PackingArrays packing = nine_spheres(d_over_D);
  pfv::Options options;
  options.split_forces = true;
  options.conductance = law;
  pfv::Flow flow(upward_box(wall), viscosity_one(), options);
  const pfv::Forces forces = flow.evaluate(packing.view());
  return {forces, flow.report()};
}

pfv::Wall wall_of(const Row& row) {
  return row.at("wall") == "symmetry" ? pfv::Wall::symmetry : pfv::Wall::no_slip;
}

TEST(EightSpheres, EachTakesAnEighthOfThePressureDifference) {
  const Solution s = solve(0.0, pfv::Wall::symmetry);
  for (int k = 0; k < 8; ++k) {
    EXPECT_NEAR(s.forces.total(2, k), 1.0 / 8.0, 1e-14);
    // pressure drops by half of the difference at each of the two layers, over a disc pi r²
    EXPECT_NEAR(s.forces.pressure(2, k), pi * 0.25 * 0.25 / 2.0, 1e-14);
  }
}

TEST(EightSpheres, NoSlipWallsTakeTheirShareAndTheSpheresTheRest) {
  const Solution s = solve(0.0, pfv::Wall::no_slip);
  double walls = 0.0;
  for (int face = 0; face < 4; ++face) walls += s.report.faces[face].force_viscous[2];
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(s.forces.total(2, k), (1.0 - walls) / 8.0, 1e-14);
}

// Goal: within 5 % at all d/D. Measured within 3.5 %.
TEST(NineSpheres, SymmetryWallsGiveTheStokesPermeabilityWithin5Percent) {
  const std::vector<double> recorded{0.9790, 1.0345, 1.0331, 1.0208, 0.9984, 0.9807};
  std::size_t i = 0;
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    if (wall_of(row) != pfv::Wall::symmetry) continue;
    const Solution s = solve(number(row, "d_over_D"), pfv::Wall::symmetry);
    const double ratio = *s.report.permeability / number(row, "permeability");
    EXPECT_NEAR(ratio, recorded.at(i++), 1e-4) << "d/D " << row.at("d_over_D");
    EXPECT_NEAR(ratio, 1.0, 0.035) << "d/D " << row.at("d_over_D");
  }
  EXPECT_EQ(i, recorded.size());
}

// With no-slip walls the law is low: it knows a wall only by its area, and pays no attention to the
// profile across the wide gap along it (conductance study). Recorded beside the Stokes solution.
TEST(NineSpheres, NoSlipWallsGiveTheRecordedShareOfTheStokesPermeability) {
  const std::vector<double> recorded{0.8178, 0.9284, 0.9235, 0.8825, 0.7842, 0.6972};
  std::size_t i = 0;
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    if (wall_of(row) != pfv::Wall::no_slip) continue;
    const Solution s = solve(number(row, "d_over_D"), pfv::Wall::no_slip);
    EXPECT_NEAR(*s.report.permeability / number(row, "permeability"), recorded.at(i++), 1e-4)
        << "d/D " << row.at("d_over_D");
  }
}

// The paper's effective radius gives 0.39 of the Stokes permeability on average with no-slip walls;
// ours lies at 0.43-0.47 in this cell, as in the conductance study.
TEST(NineSpheres, EffectiveRadiusGivesTheRecordedShareOfTheStokesPermeability) {
  const std::vector<double> recorded{0.4649, 0.4934, 0.4722, 0.4359, 0.4329, 0.4406};
  std::size_t i = 0;
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    if (wall_of(row) != pfv::Wall::no_slip) continue;
    const Solution s = solve(number(row, "d_over_D"), pfv::Wall::no_slip,
                             pfv::ConductanceLaw::effective_radius);
    EXPECT_NEAR(*s.report.permeability / number(row, "permeability"), recorded.at(i++), 1e-4)
        << "d/D " << row.at("d_over_D");
  }
}

// Measured against the Stokes solution in all ten cells: totals of the big spheres 0.0-1.1 % high;
// their pressure parts 1.0-5.1 % high and viscous parts 3.0-24 % low (the split, not the sum,
// depends on what A^k and A^f take).
TEST(NineSpheres, ForcesOnTheBigSpheresAreTheStokesForces) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    const Solution s = solve(number(row, "d_over_D"), wall_of(row));
    for (int k = 0; k < 8; ++k) {
      EXPECT_NEAR(s.forces.total(2, k) / number(row, "big_total"), 1.0, 0.0115);
      EXPECT_NEAR(s.forces.pressure(2, k) / number(row, "big_pressure"), 1.031, 0.0215);
      EXPECT_NEAR(s.forces.viscous(2, k) / number(row, "big_viscous"), 0.866, 0.1045);
    }
  }
}

// A ninth sphere much smaller than its pore lies within one pressure gradient that the throats
// around it cannot resolve: 56 % low at d/D = 0.1, 29 % at 0.2, within 7.3 % from 0.4 on.
TEST(NineSpheres, ForceOnTheSmallSphereIsTheStokesForceFromDOverD04On) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    const double d_over_D = number(row, "d_over_D");
    if (d_over_D == 0.0) continue;
    const Solution s = solve(d_over_D, wall_of(row));
    const double ratio = s.forces.total(2, 8) / number(row, "small_total");
    if (d_over_D < 0.15) {
      EXPECT_NEAR(ratio, 0.4435, 6e-4);
    } else if (d_over_D < 0.3) {
      EXPECT_NEAR(ratio, 0.7103, 6e-4);
    } else {
      EXPECT_NEAR(ratio, 1.0, 0.0725) << "d/D " << d_over_D;
    }
  }
}

// The open-throat law's share for small spheres in big pores: measured 0.943, 0.987, 1.052, 0.997
// and 1.004 (no-slip walls), 0.944, 0.988, 1.054, 0.999 and 1.007 (symmetry) for d/D from 0.1 to
// 0.72.
TEST(NineSpheres, OpenThroatGivesTheSmallSphereItsStokesForceWithin6PercentDownToDOverD01) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    const double d_over_D = number(row, "d_over_D");
    if (d_over_D == 0.0) continue;
    const Solution s = solve(d_over_D, wall_of(row), pfv::ConductanceLaw::open_throat);
    EXPECT_NEAR(s.forces.total(2, 8) / number(row, "small_total"), 1.0, 0.057)
        << "d/D " << d_over_D;
    EXPECT_LT(s.report.force_balance_error, 1e-14);
  }
}

// Table 2 of the paper, d/D = 0.72, no-slip walls. Goals: totals within 10 % of finite elements
// (measured 1.0 and 0.2 %), no line further from them than the paper's PFV column: neither from
// ours nor from the paper's. The paper's column has the unsigned partition and walls of finite
// radius; its total on the solid misses 1 by 1.2e-4, ours does not (below).
TEST(NineSpheres, Table2IsNowhereFurtherFromFiniteElementsThanThePapersColumn) {
  const Solution s = solve(0.72, pfv::Wall::no_slip);
  const std::vector<Row> rows = table("stokes_nine_spheres.csv");
  const auto row = std::find_if(rows.begin(), rows.end(), [](const Row& r) {
    return r.at("d_over_D") == "0.72" && r.at("wall") == "no_slip";
  });
  ASSERT_NE(row, rows.end());
  struct Line {
    const char* name;
    double ours, elements, papers_elements, papers_pfv;
    double error;  ///< recorded, of ours over our finite elements
  };
  const auto exact = [&](const char* column) { return number(*row, column); };
  const std::vector<Line> lines{
      {"big, viscous", s.forces.viscous(2, 0), exact("big_viscous"), 1.51e-2, 1.06e-2, -0.236},
      {"big, pressure", s.forces.pressure(2, 0), exact("big_pressure"), 9.09e-2, 9.64e-2, 0.051},
      {"big, total", s.forces.total(2, 0), exact("big_total"), 1.06e-1, 1.07e-1, 0.0097},
      {"small, viscous", s.forces.viscous(2, 8), exact("small_viscous"), 9.38e-3, 5.83e-3, -0.263},
      {"small, pressure", s.forces.pressure(2, 8), exact("small_pressure"), 5.17e-2, 5.72e-2,
       0.050},
      {"small, total", s.forces.total(2, 8), exact("small_total"), 6.04e-2, 6.30e-2, 0.0023},
      {"wall, viscous", s.report.faces[0].force_viscous[2], exact("side_wall_viscous"), 2.27e-2,
       2.03e-2, -0.087},
      // the paper's only; the mean of the pressures on the two faces is exact
      {"wall, pressure", std::abs(s.report.faces[0].force_pressure[0]), 0.5, 4.98e-1, 5.00e-1,
       0.0}};
  for (const Line& line : lines) {
    EXPECT_NEAR(line.ours / line.elements - 1.0, line.error, 5e-4) << line.name;
    for (const double reference : {line.elements, line.papers_elements})
      EXPECT_LE(std::abs(line.ours - reference), std::abs(line.papers_pfv - reference) + 1e-12)
          << line.name;
  }
}

TEST(NineSpheres, TotalForceOnTheSolidIsThePressureDifference) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    const Solution s = solve(number(row, "d_over_D"), wall_of(row));
    double solid = s.report.force_sum[2];
    for (int face = 0; face < 4; ++face) solid += s.report.faces[face].force_viscous[2];
    EXPECT_NEAR(solid, 1.0, 1e-14);  // the paper promises 1e-7
  }
}

// Measured 8.7 % low, whatever the ninth sphere (8.3 % at d/D 0.1, whose one mesh has the wall's
// share 0.4 % low).
TEST(NineSpheres, NoSlipWallsTakeTheirStokesShareWithin9Percent) {
  for (const Row& row : table("stokes_nine_spheres.csv")) {
    if (wall_of(row) != pfv::Wall::no_slip) continue;
    const Solution s = solve(number(row, "d_over_D"), pfv::Wall::no_slip);
    const double recorded = number(row, "d_over_D") == 0.1 ? 0.9166 : 0.9132;
    for (int face = 0; face < 4; ++face)
      EXPECT_NEAR(s.report.faces[face].force_viscous[2] / number(row, "side_wall_viscous"),
                  recorded, 5e-4);
  }
}

}  // namespace
}  // namespace nine_spheres_test
