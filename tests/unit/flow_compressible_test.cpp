// SPDX-License-Identifier: GPL-3.0-or-later
// Compressible pore fluid: V^f / (K_f dt) (p - p_old) = - dV/dt + inflow, pore by pore.
#include "step/built_network.hpp"
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace flow_compressible_test {
namespace {

using namespace support;

constexpr double dt = 1e-3, bulk_modulus = 2e3;

pfv::Fluid compressible(double modulus = bulk_modulus) {
  pfv::Fluid fluid = viscosity_one();
  fluid.bulk_modulus = modulus;
  return fluid;
}

/// A sealed box whose top moves down with its grains.
struct SealedBox {
  pfv::PackingArrays packing = random_packing(60, 0.05, 0.1, 3);
  pfv::Box box;
  pfv::Options options;

  SealedBox() {
    box[pfv::Face::zhi].velocity = -1.0;
    packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
    packing.velocities.row(2) = -packing.positions.row(2);
    options.retriangulation_strain = 1e9;
  }
  double fluid_volume() const {
    return pfv::storage_volumes(stages_of(packing, box).throats).sum();
  }
};

TEST(CompressibleFluid, SealedBoxGainsTheBulkModulusTimesItsStrain) {
  const SealedBox sealed;
  pfv::Flow flow(sealed.box, compressible(), sealed.options);
  flow.step(sealed.packing.view(), dt);
  const double each = bulk_modulus * dt * 1.0 / sealed.fluid_volume();  // - K_f dt (dV/dt) / V
  EXPECT_NEAR(flow.mean_pressure() / each, 1.0, 1e-12);
  for (int i = 1; i < 100; ++i) flow.step(sealed.packing.view(), dt);
  EXPECT_NEAR(flow.mean_pressure() / (100.0 * each), 1.0, 1e-11);
  EXPECT_EQ(flow.report().counts.factor, 1);
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);
  EXPECT_NEAR(flow.report().storage_rate, 1.0, 1e-11);
}

TEST(CompressibleFluid, TheFluidVolumeOfSeparateSpheresIsTheBoxLessTheSpheres) {
  const SealedBox sealed;
  EXPECT_NEAR(sealed.fluid_volume(), 1.0 - solid_volume(sealed.packing), 1e-13);
}

TEST(CompressibleFluid, ANewNetworkConservesTheStoredFluid) {
  SealedBox sealed;
  pfv::Flow flow(sealed.box, compressible(), sealed.options);
  for (int i = 0; i < 20; ++i) flow.step(sealed.packing.view(), dt);
  const double before = flow.mean_pressure() * sealed.fluid_volume();

  sealed.packing.positions += 20 * dt * sealed.packing.velocities;
  sealed.packing.velocities.resize(3, 0);
  sealed.box[pfv::Face::zhi].velocity = 0.0;
  sealed.box.upper[2] -= 20 * dt;
  flow.set_box(sealed.box);
  flow.rebuild();
  flow.step(sealed.packing.view(), dt);
  EXPECT_EQ(flow.retriangulations(), 1);
  EXPECT_NEAR(flow.mean_pressure() * sealed.fluid_volume() / before, 1.0, 1e-12);
}

// A cell that is there before and after keeps its pressure, wherever its dual vertex lies.
TEST(CompressibleFluid, ANewNetworkOfTheSamePackingChangesNothing) {
  const SealedBox sealed;
  pfv::Flow kept(sealed.box, compressible(), sealed.options);
  pfv::Flow rebuilt(sealed.box, compressible(), sealed.options);
  for (int i = 0; i < 3; ++i) {
    kept.step(sealed.packing.view(), dt);
    rebuilt.step(sealed.packing.view(), dt);
    rebuilt.rebuild();
  }
  const Eigen::VectorXd& expected = kept.pore_pressures();
  EXPECT_LT((rebuilt.pore_pressures() - expected).norm(), 1e-12 * expected.norm());
}

/// The packing does not change, but for the frame: on a new network, which has other images of some pores at home, the
/// forces are those that it has where it was, also where the gradient changes in the same step.
TEST(CompressibleFluid, AnotherImageOfAPoreAtHomeChangesNoForces) {
  pfv::Box box;
  box.periodic = {true, true, true};
  pfv::PackingArrays packing = random_packing(60, 0.05, 0.1, 3);
  const auto forces_after = [&](const Eigen::Vector3d& way) {
    pfv::PackingArrays grains = packing;
    box.pressure_gradient = {12.0, -7.0, 3.0};
    pfv::Flow flow(box, compressible());
    for (int step = 0; step < 3; ++step) flow.step(grains.view(), dt);
    grains.positions.colwise() += way;
    for (double& x : grains.positions.reshaped()) x -= std::floor(x);
    box.pressure_gradient = {-30.0, 0.0, 20.0};
    flow.set_box(box);
    flow.rebuild();
    return Eigen::Matrix3Xd(flow.step(grains.view(), dt).total);
  };
  const Eigen::Matrix3Xd here = forces_after(Eigen::Vector3d::Zero());
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(0.06, 0.0, 0.0), Eigen::Vector3d(-0.03, 0.05, 0.04)})
    EXPECT_LT((forces_after(way) - here).norm(), 1e-9 * here.norm());
}

TEST(CompressibleFluid, TendsToTheIncompressibleResultLikeOneOverTheModulus) {
  SealedBox piston;
  piston.box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Flow stiff(piston.box, viscosity_one());
  stiff.evaluate(piston.packing.view());
  const auto difference = [&](double modulus) {
    pfv::Flow flow(piston.box, compressible(modulus));
    flow.evaluate(piston.packing.view(), dt);
    return (flow.pore_pressures() - stiff.pore_pressures()).norm() /
           stiff.pore_pressures().norm();
  };
  const double at_1e10 = difference(1e10), at_1e11 = difference(1e11);
  EXPECT_LT(at_1e10, 1e-3);
  EXPECT_NEAR(at_1e10 / at_1e11, 10.0, 0.1);
}

TEST(CompressibleFluid, ReachesTheSteadyStateOfTheIncompressibleOne) {
  const auto packing = random_packing(60, 0.05, 0.1, 3);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), compressible(1e6));
  for (int i = 0; i < 400; ++i) flow.step(packing.view(), 10.0);
  pfv::Flow steady(upward_box(pfv::Wall::no_slip), viscosity_one());
  steady.evaluate(packing.view());
  EXPECT_LT((flow.pore_pressures() - steady.pore_pressures()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(flow.report().permeability.has_value());  // not steady by construction
}

TEST(CompressibleFluid, FluxesBalanceWithWhatIsStored) {
  const auto packing = random_packing(60, 0.05, 0.1, 3);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), compressible());
  for (int i = 0; i < 3; ++i) {
    flow.step(packing.view(), dt);
    const pfv::Report report = flow.report();
    EXPECT_GT(report.storage_rate, 0.0);
    EXPECT_NEAR(report.inflow - report.outflow, report.storage_rate, 1e-12 * report.inflow);
    EXPECT_LT(std::abs(report.mass_error), 1e-12);
  }
}

TEST(CompressibleFluid, AnotherTimeStepNeedsAnotherFactorButNoOrdering) {
  const auto packing = random_packing(60, 0.05, 0.1, 3);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), compressible());
  flow.step(packing.view(), dt);
  flow.step(packing.view(), dt);
  flow.step(packing.view(), 2 * dt);
  EXPECT_EQ(flow.report().counts.factor, 2);
  EXPECT_EQ(flow.report().counts.order, 1);
  EXPECT_EQ(flow.report().counts.triangulate, 1);
}

TEST(CompressibleFluid, RestartsFromItsState) {
  const SealedBox sealed;
  pfv::Flow flow(sealed.box, compressible(), sealed.options);
  for (int i = 0; i < 5; ++i) flow.step(sealed.packing.view(), dt);
  pfv::Flow restarted(sealed.box, compressible(), sealed.options);
  restarted.set_state(flow.state());
  EXPECT_TRUE(restarted.step(sealed.packing.view(), dt).total ==
              flow.step(sealed.packing.view(), dt).total);
  EXPECT_EQ(restarted.time(), flow.time());
}

// The flow that the state is of, too: its pressures went on as they were, with the time of the state.
TEST(CompressibleFluid, GoesBackToItsOwnState) {
  const SealedBox sealed;
  pfv::Flow flow(sealed.box, compressible(), sealed.options), straight(sealed.box, compressible(), sealed.options);
  for (int i = 0; i < 5; ++i) {
    flow.step(sealed.packing.view(), dt);
    straight.step(sealed.packing.view(), dt);
  }
  const pfv::FlowState state = flow.state();
  for (int i = 0; i < 3; ++i) flow.step(sealed.packing.view(), 2 * dt);
  flow.set_state(state);
  EXPECT_THROW(flow.mean_pressure(), pfv::InputError);  // that of the steps that are taken back
  EXPECT_TRUE(flow.step(sealed.packing.view(), dt).total == straight.step(sealed.packing.view(), dt).total);
  EXPECT_EQ(flow.time(), straight.time());
  EXPECT_EQ(flow.retriangulations(), 0);
}

TEST(CompressibleFluid, RefusesTheStateOfAnotherNetworkUntilItGetsItsOwn) {
  const SealedBox sealed;
  pfv::Flow flow(sealed.box, compressible(), sealed.options);
  flow.step(sealed.packing.view(), dt);
  const pfv::FlowState own = flow.state();
  pfv::FlowState other = own;
  other.pore_pressures.pop_back();
  const std::string counts = std::to_string(other.pore_pressures.size()) + " pore pressures, and the network of "
                             "this packing has " + std::to_string(own.pore_pressures.size()) + " pores";
  pfv::Flow restarted(sealed.box, compressible(), sealed.options);
  restarted.set_state(other);
  for (int again = 0; again < 2; ++again)
    expect_line(refusal([&] { restarted.step(sealed.packing.view(), dt); }), counts);
  restarted.set_state(own);
  EXPECT_TRUE(restarted.step(sealed.packing.view(), dt).total == flow.step(sealed.packing.view(), dt).total);
}

}  // namespace
}  // namespace flow_compressible_test
