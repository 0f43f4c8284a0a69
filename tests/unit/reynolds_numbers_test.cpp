// SPDX-License-Identifier: GPL-3.0-or-later
// How fast water goes through the throats.
#include "pfv/flow.hpp"
#include "pfv/io.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

/// In a cubic lattice each throat across the flow carries its share of the superficial velocity U: Re = rho U d / mu.
TEST(ReynoldsNumbers, OfACubicLatticeIsThatOfTheSuperficialVelocity) {
  const pfv::PackingArrays lattice = support::lattice(support::Lattice::sc, 4, 0.9);
  pfv::Fluid fluid;
  fluid.viscosity = 0.02;
  fluid.density = 800.0;
  pfv::Flow flow(support::upward_box(pfv::Wall::symmetry), fluid);
  flow.evaluate(lattice.view());
  const pfv::Report report = flow.report();
  const double superficial = report.inflow, diameter = 2.0 * lattice.radii[0];  // through a face of 1 m2
  const double expected = fluid.density * superficial * diameter / fluid.viscosity;
  EXPECT_NEAR(*report.reynolds_largest / expected, 1.0, 1e-9);
  EXPECT_NEAR(*report.reynolds_mean / expected, 1.0, 1e-9);
  EXPECT_NE(pfv::summary_of(report).find("Reynolds number of the throats: largest"), std::string::npos);
}

TEST(ReynoldsNumbers, AreZeroWhereNothingFlows) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(1.0);
  pfv::Flow flow(box, {});
  flow.evaluate(support::lattice(support::Lattice::sc, 2, 0.9).view());
  EXPECT_LT(*flow.report().reynolds_largest, 1e-9);
}
