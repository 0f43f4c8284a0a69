// SPDX-License-Identifier: GPL-3.0-or-later
// How fast water goes through the throats, and how far grains fly before it stops them.
#include "pfv/flow.hpp"
#include "pfv/io.hpp"
#include "pfv/stokes_numbers.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>

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

/// rho_s d v / (9 mu) of two spheres; a held one, whose mass is infinite, and a sphere of a body do not count.
TEST(StokesNumbers, AreThoseOfGrainsThatMoveFreely) {
  const double density = 2600.0, viscosity = 0.5;
  pfv::PackingArrays grains;
  grains.ids.setLinSpaced(4, 1, 4);
  grains.positions = Eigen::Matrix3Xd::Zero(3, 4);
  grains.radii = Eigen::Vector4d(0.01, 0.02, 0.02, 0.02);
  grains.velocities = Eigen::Matrix3Xd::Zero(3, 4);
  grains.velocities.row(1) << 0.3, -0.1, 50.0, 60.0;
  grains.bodies = Eigen::Vector4i(-1, -1, -1, 0);
  Eigen::VectorXd masses = density * 4.0 / 3.0 * M_PI * grains.radii.array().cube();
  masses[2] = std::numeric_limits<double>::infinity();
  const pfv::StokesNumbers found = pfv::stokes_numbers(grains.view(), masses, viscosity);
  const double first = density * 0.02 * 0.3 / (9.0 * viscosity), second = density * 0.04 * 0.1 / (9.0 * viscosity);
  EXPECT_NEAR(found.largest / first, 1.0, 1e-12);
  EXPECT_NEAR(found.mass, masses[0] + masses[1], 1e-12);
  EXPECT_NEAR(found.mean / ((first + 8.0 * second) / 9.0), 1.0, 1e-12);
}

TEST(StokesNumbers, AreZeroForGrainsAtRestAndForNone) {
  pfv::PackingArrays grains;
  EXPECT_EQ(pfv::stokes_numbers(grains.view(), Eigen::VectorXd(), 1.0).largest, 0.0);
  grains.ids.setLinSpaced(1, 1, 1);
  grains.positions = grains.velocities = Eigen::Matrix3Xd::Zero(3, 1);
  grains.radii = Eigen::VectorXd::Constant(1, 0.01);
  EXPECT_EQ(pfv::stokes_numbers(grains.view(), Eigen::VectorXd::Ones(1), 1.0).mean, 0.0);
}
