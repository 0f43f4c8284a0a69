// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that move just as the fluid does: every pressure is zero, and what is computed of it round-off.
#include "pfv/pfv.hpp"
#include "support/long_steps.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace plug_flow_test {
namespace {

using namespace support;

constexpr double speed = 0.01;  // m/s
// A pressure difference that this flow would need through grains at rest, Pa: 12 mu v L / L².
constexpr double at_rest_scale = 0.12;

/// What the whole lower face brings in goes out above.
pfv::Box plug_box() {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].wall = pfv::Wall::symmetry;  // the others hold the fluid
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(speed);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  return box;
}

pfv::PackingArrays plug(double share = 1.0) {
  auto packing = random_packing(60, 0.05, 0.09, 3);
  packing.velocities.setZero(3, packing.ids.size());
  packing.velocities.row(2).setConstant(share * speed);
  return packing;
}

void expect_no_pressure(const pfv::FlowModel& flow) {
  EXPECT_LT(std::abs(flow.mean_pressure()), 1e-12 * at_rest_scale);
  EXPECT_LT(flow.forces().total.cwiseAbs().maxCoeff(), 1e-12 * at_rest_scale);
  const pfv::Report report = flow.report();
  EXPECT_NEAR(report.inflow, speed, 1e-12 * speed);
  EXPECT_NEAR(report.outflow, speed, 1e-12 * speed);
  EXPECT_LT(std::abs(report.mass_error), 1e-13);
  EXPECT_LT(report.force_balance_error, 1e-9);
  EXPECT_LT(report.residual, 1e-9);
  EXPECT_FALSE(report.permeability);
}

TEST(PlugFlow, HasNoPressureWithAnySolver) {
  for (const pfv::SolverKind solver : {pfv::SolverKind::automatic, pfv::SolverKind::klu2,
                                       pfv::SolverKind::cg, pfv::SolverKind::gauss_seidel}) {
    pfv::Options options;
    options.solver = solver;
    pfv::Flow flow(plug_box(), viscosity_one(), options);
    flow.evaluate(plug().view());
    expect_no_pressure(flow);
  }
}

TEST(PlugFlow, HasNoPressureInMixedPrecisionAndInACompressibleFluid) {
  pfv::Options options;
  options.precision = pfv::Precision::mixed;
  pfv::Flow mixed(plug_box(), viscosity_one(), options);
  mixed.evaluate(plug().view());
  expect_no_pressure(mixed);
  pfv::Fluid stiff = viscosity_one();
  stiff.bulk_modulus = 1e6;
  pfv::Flow compressible(plug_box(), stiff);
  compressible.step(plug().view(), 1e-3);
  expect_no_pressure(compressible);
}

// The first solve on a network must not decide that its solves lose digits.
TEST(PlugFlow, LeavesTheNetworkAsGoodAsItFindsIt) {
  pfv::Flow flow(plug_box(), viscosity_one()), fresh(plug_box(), viscosity_one());
  flow.evaluate(plug().view());
  const auto slower = plug(0.5);
  flow.evaluate(slower.view());
  const auto solves = flow.report().counts.solve;
  flow.evaluate(slower.view());
  EXPECT_EQ(flow.report().counts.solve, solves + 1);
  EXPECT_EQ((flow.pore_pressures() - (fresh.evaluate(slower.view()), fresh.pore_pressures()))
                .cwiseAbs().maxCoeff(), 0.0);
}

// Between no motion and plug flow the pressures fall in proportion: those that nearly cancel keep digits.
TEST(PlugFlow, IsTheLimitOfTheFlowPastSlowerGrains) {
  pfv::Flow flow(plug_box(), viscosity_one());
  flow.evaluate(plug(0.0).view());
  const double at_rest = flow.mean_pressure();
  for (const double slower : {1e-2, 1e-5, 1e-8}) {
    flow.evaluate(plug(1.0 - slower).view());
    EXPECT_NEAR(flow.mean_pressure() / (slower * at_rest), 1.0, 1e-14 + 1e-15 / slower);
  }
}

TEST(PlugFlow, GoesOnInStagedAndImplicitSteps) {
  const auto packing = plug();
  const Eigen::VectorXd masses = Eigen::VectorXd::Constant(packing.ids.size(), 1e-3);
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
  const pfv::GrainDynamics grains{{masses.data(), masses.size()}, {none.data(), 3, none.cols()}, {}};
  pfv::Flow flow(plug_box(), viscosity_one());
  flow.evaluate(packing.view());
  const double step = 10.0 * flow.time_step_limit(masses);
  step_staged(flow, packing.view(), step, grains);
  EXPECT_GT(flow.stages(), 1);
  expect_no_pressure(flow);
  step_implicit(flow, packing.view(), step, grains);
  expect_no_pressure(flow);
}

// A lattice under a gradient: what drives it is the same in every pore, and no pressure fluctuates.
TEST(PlugFlow, HasASisterInALatticeThatAGradientDrives) {
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {0.0, 0.0, 1.0};
  std::vector<Sphere> lattice;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k)
        lattice.push_back({0.125 + 0.25 * i, 0.125 + 0.25 * j, 0.125 + 0.25 * k, 0.1});
  pfv::Flow flow(box, viscosity_one());
  flow.evaluate(packing_of(lattice).view());
  EXPECT_LT(flow.report().force_balance_error, 1e-14);
}

}  // namespace
}  // namespace plug_flow_test
