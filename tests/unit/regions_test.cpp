// SPDX-License-Identifier: GPL-3.0-or-later
// Pressures and fluxes imposed inside the packing.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace regions_test {
namespace {

using namespace support;
using pfv::Boundary;
using pfv::Face;

constexpr int xlo = static_cast<int>(Face::xlo), zhi = static_cast<int>(Face::zhi);

pfv::Region point(double x, double y, double z, const Boundary& boundary) {
  return {{x, y, z}, {x, y, z}, boundary};
}

/// All faces sealed but the upper one.
pfv::Box open_lid() {
  pfv::Box box;
  box[Face::zhi].boundary = Boundary::pressure(0.0);
  return box;
}

struct Solved {
  pfv::Report report;
  Eigen::VectorXd pressures;
  double below, above;  ///< flux through planes on either side of z = 0.5, m³/s
};

Solved solve(const pfv::Box& box, const pfv::PackingArrays& packing) {
  pfv::Flow flow(box, viscosity_one());
  flow.evaluate(packing.view());
  return {flow.report(), flow.pore_pressures(), flow.plane_flux(2, 0.25),
          flow.plane_flux(2, 0.75)};
}

TEST(Regions, WhatAPointBringsInLeavesThroughTheLid) {
  pfv::Box box = open_lid();
  box.regions = {point(0.5, 0.5, 0.5, Boundary::flux(3.0))};
  const Solved s = solve(box, data_packing("packing_500.csv"));
  ASSERT_EQ(s.report.openings.size(), 1u);
  EXPECT_EQ(s.report.openings[0].name, "region 1");
  EXPECT_EQ(s.report.openings[0].pores, 1);
  EXPECT_NEAR(s.report.openings[0].flux, 3.0, 1e-12);
  EXPECT_NEAR(s.report.faces[zhi].flux, -3.0, 1e-12);
  EXPECT_NEAR(s.below, 0.0, 1e-12);
  EXPECT_NEAR(s.above, 3.0, 1e-12);
  EXPECT_NEAR(s.report.inflow, 3.0, 1e-12);
  EXPECT_LT(std::abs(s.report.mass_error), 1e-15);
  EXPECT_LT(s.report.force_balance_error, 1e-12);
  EXPECT_FALSE(s.report.permeability);
}

TEST(Regions, APressureGivesTheFluxThatGivesThePressure) {
  const auto packing = data_packing("packing_500.csv");
  pfv::Box box = open_lid();
  box.regions = {{{0.3, 0.3, 0.3}, {0.6, 0.6, 0.6}, Boundary::flux(2.0)}};
  const Solved fed = solve(box, packing);
  EXPECT_GT(fed.report.openings[0].pores, 20);
  box.regions[0].boundary = Boundary::pressure(*fed.report.openings[0].pressure);
  const Solved pressed = solve(box, packing);
  EXPECT_NEAR(pressed.report.openings[0].flux, 2.0, 1e-11);
  EXPECT_LT((pressed.pressures - fed.pressures).cwiseAbs().maxCoeff(),
            3e-12 * fed.pressures.maxCoeff());  // of the solver: measured 1.7e-12
}

TEST(Regions, TwoWellsAreReciprocal) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Box box = open_lid();
  box.regions = {point(0.2, 0.3, 0.2, Boundary::flux(1.0)),
                 point(0.8, 0.6, 0.4, Boundary::flux(0.0))};
  const double there = *solve(box, packing).report.openings[1].pressure;
  std::swap(box.regions[0].boundary, box.regions[1].boundary);
  const double back = *solve(box, packing).report.openings[0].pressure;
  EXPECT_GT(there, 0.0);
  EXPECT_NEAR(back / there, 1.0, 1e-12);
}

TEST(Regions, APoreOnAFaceBelongsToItsRegionAlone) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Box box = open_lid();
  box[Face::xlo].boundary = Boundary::pressure(1.0);
  box.regions = {{{0.0, 0.0, 0.0}, {0.1, 1.0, 1.0}, Boundary::pressure(5.0)}};
  const Solved s = solve(box, packing);
  const pfv::OpeningResult& well = s.report.openings[0];
  EXPECT_GT(well.pores, 5);
  EXPECT_EQ(*well.pressure, 5.0);
  EXPECT_EQ(s.pressures.maxCoeff(), 5.0);
  EXPECT_GT(well.flux, 0.0);
  EXPECT_LE(s.report.faces[xlo].flux, 0.0);  // what is left of the face takes from the well
  EXPECT_NEAR(well.flux + s.report.faces[xlo].flux + s.report.faces[zhi].flux, 0.0,
              1e-14 * well.flux);
  EXPECT_LT(s.report.force_balance_error, 1e-12);
}

TEST(Regions, TheLaterOneWins) {
  pfv::Box box = open_lid();
  box.regions = {{{0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, Boundary::pressure(1.0)},
                 {{0.0, 0.0, 0.0}, {0.9, 0.9, 0.9}, Boundary::pressure(2.0)}};
  const Solved s = solve(box, data_packing("packing_100.csv"));
  EXPECT_EQ(s.report.openings[0].pores, 0);
  EXPECT_FALSE(s.report.openings[0].pressure);
  EXPECT_GT(s.report.openings[1].pores, 50);
}

TEST(Regions, AreRefusedWhereTheyMeanNothing) {
  const auto refused = [](const pfv::Region& region, const std::string& part) {
    pfv::Box box = open_lid();
    box.regions = {region};
    expect_line(refusal([&] { pfv::check(box); }), part);
  };
  refused(point(0.5, 0.5, 1.5, Boundary::flux(1.0)), "region 1 along z");
  refused(point(0.5, 0.5, 0.5, Boundary::sealed()), "give it one of pressure, flux");
  refused(point(0.5, NAN, 0.5, Boundary::flux(1.0)), "along y");
  refused({{0.5, 0.5, 0.5}, {0.4, 0.6, 0.6}, Boundary::flux(1.0)}, "inverted");
  refused(point(0.5, 0.5, 0.5, Boundary::pressure(INFINITY)), "region 1: pressure");
  pfv::Box covered = open_lid();
  covered.regions = {point(0.5, 0.5, 0.5, Boundary::flux(1.0)),
                     point(0.5, 0.5, 0.5, Boundary::pressure(0.0))};
  expect_line(refusal([&] { solve(covered, data_packing("packing_100.csv")); }),
              "region 1: its flux has no pore");
}

TEST(Regions, MovedOnesLeadToANewNetwork) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Box box = open_lid();
  box.regions = {point(0.2, 0.3, 0.2, Boundary::flux(1.0))};
  pfv::Flow flow(box, viscosity_one());
  flow.evaluate(packing.view());
  box.regions[0].boundary.value = 2.0;
  flow.set_box(box);
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().counts.triangulate, 1);
  EXPECT_NEAR(flow.report().openings[0].flux, 2.0, 1e-12);
  box.regions[0] = point(0.7, 0.7, 0.7, Boundary::flux(2.0));
  flow.set_box(box);
  flow.evaluate(packing.view());
  // the pressure is highest where the fluid comes in: at the pore nearest to the new place
  Eigen::Index highest = 0, nearest = 0;
  EXPECT_EQ(flow.pore_pressures().maxCoeff(&highest), *flow.report().openings[0].pressure);
  (flow.network().pore_centres.colwise() - Eigen::Vector3d(0.7, 0.7, 0.7))
      .colwise()
      .norm()
      .minCoeff(&nearest);
  EXPECT_EQ(highest, nearest);
  EXPECT_EQ(flow.report().counts.order, 2);
}

}  // namespace
}  // namespace regions_test
