// SPDX-License-Identifier: GPL-3.0-or-later
// Viscosities, pressures, densities and stiffnesses of fluid far from the usual ones.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace fluids_test {
namespace {

using namespace support;

// Stokes flow: velocities go with 1 / viscosity, forces between given pressures do not change.
TEST(Viscosity, From1em6To1e9ScalesFluxesAlone) {
  const auto packing = data_packing("packing_100.csv");
  const auto solve = [&](double viscosity) {
    pfv::Fluid fluid;
    fluid.viscosity = viscosity;
    pfv::Flow flow(upward_box(pfv::Wall::no_slip), fluid);
    const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
    record_balances(flow.report());
    return std::make_pair(flow.report(), forces);
  };
  const auto one = solve(1.0);
  for (const double viscosity : {1e-6, 1e-3, 1e3, 1e9}) {
    const auto [report, forces] = solve(viscosity);
    EXPECT_NEAR(report.inflow * viscosity / one.first.inflow, 1.0, 1e-12);
    EXPECT_NEAR(*report.permeability / *one.first.permeability, 1.0, 1e-12);
    EXPECT_LT((forces - one.second).norm(), 1e-12 * one.second.norm());
    EXPECT_LT(std::abs(report.mass_error), 1e-12);
  }
}

TEST(Viscosity, OfMovingGrainsScalesPressuresAndForces) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = 0.01 * (packing.positions.array() - 0.5);
  const auto solve = [&](double viscosity) {
    pfv::Fluid fluid;
    fluid.viscosity = viscosity;
    pfv::Flow flow(pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::no_slip),
                   fluid);
    return Eigen::Matrix3Xd(flow.evaluate(packing.view()).total);
  };
  const Eigen::Matrix3Xd one = solve(1.0);
  for (const double viscosity : {1e-6, 1e9})
    EXPECT_LT((solve(viscosity) / viscosity - one).norm(), 1e-11 * one.norm());
}

// A level pressure drives nothing, however high: not even round-off of that level.
TEST(Pressures, OfAnyLevelThatIsTheSameEverywhereDriveNothing) {
  const auto packing = data_packing("packing_100.csv");
  for (const double level : {0.0, 1e-12, 1e12}) {
    pfv::Flow flow(pressure_box(pfv::Face::zlo, level, pfv::Face::zhi, level, pfv::Wall::no_slip),
                   viscosity_one());
    EXPECT_TRUE(flow.evaluate(packing.view()).total.isZero(0.0));
    EXPECT_EQ(flow.report().inflow, 0.0);
    EXPECT_EQ(flow.report().mass_error, 0.0);
    EXPECT_TRUE((flow.pore_pressures().array() == level).all());
    EXPECT_EQ(flow.faces()[5].force_pressure[2], level);
  }
}

TEST(Pressures, DifferencesFrom1em12To1e12ScaleForcesAndFluxes) {
  const auto packing = data_packing("packing_100.csv");
  const auto solve = [&](double difference, double level) {
    pfv::Flow flow(pressure_box(pfv::Face::zlo, level + difference, pfv::Face::zhi, level,
                                pfv::Wall::no_slip), viscosity_one());
    const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
    record_balances(flow.report());
    return std::make_pair(flow.report(), forces);
  };
  const auto one = solve(1.0, 0.0);
  for (const double difference : {1e-12, 1e12}) {
    const auto [report, forces] = solve(difference, 0.0);
    EXPECT_NEAR(report.inflow / difference / one.first.inflow, 1.0, 1e-12);
    EXPECT_LT((forces / difference - one.second).norm(), 1e-12 * one.second.norm());
  }
  // on a level of 1e12 a difference of 1 has only the digits that the sum of both keeps
  const auto [report, forces] = solve(1.0, 1e12);
  EXPECT_LT((forces - one.second).norm(), 1e-12 * one.second.norm());
  EXPECT_NEAR(report.inflow / one.first.inflow, 1.0, 1e-12);
}

// A grain as dense as the fluid weighs nothing in it: lift and weight cancel, and nothing flows.
TEST(Densities, EqualToTheFluidsLeaveNoNetWeight) {
  const auto packing = data_packing("packing_100.csv");
  for (const double density : {1e-3, 1e3, 2.6e3, 1e6}) {
    pfv::Fluid fluid = viscosity_one();
    fluid.density = density;
    fluid.gravity = {0.0, 0.0, -9.81};
    pfv::Box box;
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
    pfv::Flow flow(box, fluid);
    const pfv::Forces& forces = flow.evaluate(packing.view());
    record_balances(flow.report());
    for (int k = 0; k < packing.radii.size(); ++k) {
      const double weight = density * 4.0 / 3.0 * pi * std::pow(packing.radii[k], 3) * 9.81;
      EXPECT_LT((forces.total.col(k) - Eigen::Vector3d(0, 0, weight)).norm(), 1e-14 * weight);
    }
  }
}

// All faces sealed, one moves inwards: the mean pressure is K_f times the fluid's strain for any K_f.
TEST(SealedBox, OfAnyBulkModulusTakesTheLoad) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  packing.velocities.row(2) = -packing.positions.row(2);
  pfv::Box box;
  box[pfv::Face::zhi].velocity = -1.0;
  const double dt = 1e-6, fluid_volume = 1.0 - solid_volume(packing);
  // the factor keeps V / (K_f dt) beside conductances of 1: the digits that are left fall with K_f
  for (const auto& [modulus, tolerance] :
       {std::pair{1e3, 1e-12}, std::pair{1e6, 1e-12}, std::pair{1e9, 1e-9}, std::pair{1e12, 1e-6}}) {
    pfv::Fluid fluid = viscosity_one();
    fluid.bulk_modulus = modulus;
    pfv::Flow flow(box, fluid);
    flow.step(packing.view(), dt);
    record_balances(flow.report());
    EXPECT_NEAR(flow.mean_pressure() / (modulus * dt / fluid_volume), 1.0, tolerance) << modulus;
    EXPECT_TRUE(flow.forces().total.allFinite());
  }
}

// Beyond what sixteen digits hold: a sentence, not a number.
TEST(SealedBox, OfAFluidTooStiffForItsStepIsRefusedOrRight) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  pfv::Box box;
  box[pfv::Face::zhi].velocity = -1.0;
  pfv::Fluid fluid;
  fluid.viscosity = 1e-6;
  fluid.bulk_modulus = 1e18;
  pfv::Flow flow(box, fluid);
  try {
    flow.step(packing.view(), 1.0);
    FAIL() << "solved";
  } catch (const pfv::SolverError& error) {
    expect_line(error.what(), "shorter time step");
    expect_line(error.what(), "spheres");
  }
}

}  // namespace
}  // namespace fluids_test
