// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities, fluxes through planes, means of slices and stresses of spheres.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace flow_averages_test {
namespace {

using namespace support;

TEST(FlowAverages, VelocityOfAllPoresIsTheDischargeTimesTheHeight) {
  const auto packing = data_packing("packing_500.csv");
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry}) {
    pfv::Flow flow(upward_box(wall), viscosity_one());
    flow.evaluate(packing.view());
    const pfv::SliceMeans all = flow.slice_means(2, -1.0, 2.0);
    EXPECT_EQ(all.pores, flow.network().pores());
    EXPECT_NEAR(all.velocity.z() * all.volume / flow.report().inflow, 1.0, 1e-10);
  }
}

TEST(FlowAverages, EachPlaneCarriesTheInflow) {
  const auto packing = data_packing("packing_500.csv");
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  const double inflow = flow.report().inflow;
  for (const double z : {0.0, 0.01, 0.2, 0.5, 0.77, 0.99, 1.0})
    EXPECT_NEAR(flow.plane_flux(2, z) / inflow, 1.0, 1e-10) << z;
  EXPECT_LT(std::abs(flow.plane_flux(0, 0.5)), 0.2 * inflow);
  expect_line(refusal([&] { flow.plane_flux(2, 1.5); }), "outside the box");
  expect_line(refusal([&] { flow.plane_flux(3, 0.5); }), "axis");
  expect_line(refusal([&] { flow.slice_means(2, 3.0, 4.0); }), "no pore");
}

// In a lattice all layers are alike, and the flow goes straight up.
TEST(FlowAverages, VelocitiesAroundTheSpheresOfALatticeAreEqual) {
  const int n = 5;
  const auto packing = lattice(Lattice::sc, n);
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one());
  flow.evaluate(packing.view());
  const Eigen::Matrix3Xd velocities = flow.sphere_velocities();
  const double middle = velocities(2, (n * n * n) / 2);
  EXPECT_GT(middle, 0.0);
  for (Eigen::Index k = 0; k < velocities.cols(); ++k) {
    EXPECT_NEAR(velocities(0, k) / middle, 0.0, 1e-9);
    EXPECT_NEAR(velocities(1, k) / middle, 0.0, 1e-9);
    const double z = packing.positions(2, k);
    if (z > 1.0 / n && z < 1.0 - 1.0 / n) {
      EXPECT_NEAR(velocities(2, k) / middle, 1.0, 1e-9);
    }
  }
}

TEST(FlowAverages, AnEvenPressureIsAnEvenStress) {
  const auto packing = data_packing("packing_500.csv");
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 7.0, pfv::Face::zhi, 7.0, pfv::Wall::no_slip),
                 viscosity_one());
  flow.evaluate(packing.view());
  const auto stresses = flow.sphere_stresses();
  ASSERT_EQ(stresses.cols(), packing.view().size());
  for (Eigen::Index k = 0; k < stresses.cols(); ++k)
    for (int entry = 0; entry < 6; ++entry)
      EXPECT_NEAR(stresses(entry, k), entry < 3 ? -7.0 : 0.0, 1e-9) << k;
}

// The pressure's part has three times the mean pressure on the surface as its trace. The viscous part is
// even only as far as the two triangles are that make up each square throat of the lattice.
TEST(FlowAverages, MeanStressIsTheMeanPressureUpToTheViscousPart) {
  const auto packing = lattice(Lattice::sc, 4);
  pfv::Options options;
  options.sphere_pressure = true;
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one(), options);
  flow.evaluate(packing.view());
  const auto stresses = flow.sphere_stresses();
  for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
    const double mean = stresses.col(k).head(3).mean();
    EXPECT_NEAR(mean, -flow.forces().sphere_pressure[k], 0.02) << k;
    EXPECT_LT(stresses.col(k).tail(3).norm(), 0.005) << k;
  }
}

TEST(FlowAverages, NothingCrossesASealedWall) {
  const auto packing = random_packing(60, 0.05, 0.12, 4);
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one());
  flow.evaluate(packing.view());
  const pfv::PoreNetwork& network = flow.network();
  ASSERT_LE(network.pore_centres.topRows<2>().minCoeff(), 0.0) << "no centre lies beyond";
  for (const int axis : {0, 1})
    for (const double place : {0.0, 1.0}) EXPECT_EQ(flow.plane_flux(axis, place), 0.0);
  EXPECT_NEAR(flow.plane_flux(2, 0.0), flow.report().inflow, 1e-12 * flow.report().inflow);
  EXPECT_NEAR(flow.plane_flux(2, 1.0), flow.report().inflow, 1e-12 * flow.report().inflow);
}

}  // namespace
}  // namespace flow_averages_test
