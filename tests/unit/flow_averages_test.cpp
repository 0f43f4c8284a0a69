// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities, fluxes through planes, means of slices and stresses of spheres.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <memory>
#include <utility>

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

/// A periodic cell; where its packing lies in it is the same to the fluid.
class PeriodicCell {
 public:
  PeriodicCell(const Eigen::Vector3d& gradient, const Eigen::Vector3d& tilt) {
    box_.periodic = {true, true, true};
    box_.pressure_gradient = gradient;
    box_.tilt = tilt;
    edges_ << 1, tilt[0], tilt[1], 0, 1, tilt[2], 0, 0, 1;
  }
  /// The place or the image of it that is in the brick at home, and what the gradient raises that by, Pa.
  std::pair<Eigen::Vector3d, double> wrapped(const Eigen::Vector3d& place) const {
    Eigen::Vector3d home = place;
    for (const int axis : {2, 1, 0}) home -= std::floor(home[axis]) * edges_.col(axis);
    return {home, box_.pressure_gradient.dot(home - place)};
  }
  std::unique_ptr<pfv::Flow> flow_of(pfv::PackingArrays packing, const Eigen::Vector3d& shift) const {
    for (auto place : packing.positions.colwise()) place = wrapped(place + shift).first;
    auto flow = std::make_unique<pfv::Flow>(box_, viscosity_one());
    flow->evaluate(packing.view());
    return flow;
  }

 private:
  pfv::Box box_;
  Eigen::Matrix3d edges_;
};

// A place at home may lie in the image of a cell whose pore is beyond the other side.
TEST(FlowAverages, PressuresAtPlacesDoNotDependOnWhereAPeriodicCellBegins) {
  const auto packing = random_packing(150, 0.07, 0.09, 3);
  const Eigen::Vector3d shift(0.37, 0.61, 0.23);
  for (const Eigen::Vector3d& tilt : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.2, -0.1, 0.3)}) {
    const PeriodicCell cell({1.0, 2.0, 3.0}, tilt);
    const auto here = cell.flow_of(packing, Eigen::Vector3d::Zero()), there = cell.flow_of(packing, shift);
    Random random(5);
    double first = 0.0;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d place = random.in_cube(0.0, 1.0);
      const auto [moved, raised] = cell.wrapped(place + shift);
      const double apart = there->pressure_at(moved) - raised - here->pressure_at(place);
      if (k == 0) first = apart;  // the mean pressure of each is its own
      EXPECT_NEAR(apart, first, 1e-10) << place.transpose();
    }
  }
}

TEST(FlowAverages, MeanPressuresOfPlanesDoNotDependOnWhereAPeriodicCellBegins) {
  const auto packing = random_packing(150, 0.07, 0.09, 3);
  const PeriodicCell cell({1.0, 0.0, 0.0}, {0, 0, 0});
  const Eigen::Vector3d shift(0.37, 0.61, 0.23);
  const auto here = cell.flow_of(packing, Eigen::Vector3d::Zero()), there = cell.flow_of(packing, shift);
  const auto apart = [&](double x) {
    const auto [moved, raised] = cell.wrapped({x + shift.x(), 0.5, 0.5});
    return there->plane_pressure(0, moved.x()) - raised - here->plane_pressure(0, x);
  };
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(apart((k + 0.5) / 20), apart(0.5), 1e-11) << k;
}

}  // namespace
}  // namespace flow_averages_test
