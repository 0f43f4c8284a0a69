// SPDX-License-Identifier: GPL-3.0-or-later
// What a host leaves to the library: the coupling of each step, its warnings, and when to solve next.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace pfv {
namespace automatic_coupling_test {
namespace {

using ::support::expect_line;
using ::support::refusal;

/// Grains between two open faces, and all that a step may have to know of them.
struct Bed {
  PackingArrays packing = dense_packing(60);
  Eigen::VectorXd masses =
      2600.0 * 4.0 / 3.0 * 3.14159265358979 * packing.radii.array().cube();
  Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
  Flow flow;

  explicit Bed(Fluid fluid = {})
      : flow(::support::pressure_box(Face::zlo, 1.0, Face::zhi, 0.0, Wall::symmetry), fluid) {
    packing.velocities = 1e-6 * packing.positions;
    flow.evaluate(packing.view(), 1.0);
  }
  double limit() { return flow.time_step_limit(masses); }
  GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  }
  Coupling chosen(double dt) {
    const GrainDynamics known = dynamics();
    flow.advance(packing.view(), dt, Step::trial(Coupling::automatic, known));
    return flow.coupling();
  }
};

TEST(AutomaticCoupling, IsExplicitBelowTheLimitWithTheSameBytes) {
  Bed bed, plain;
  const double dt = 0.9 * bed.limit();
  EXPECT_EQ(bed.chosen(dt), Coupling::explicit_step);
  const GrainDynamics known = bed.dynamics();
  const Forces& forces =
      bed.flow.advance(bed.packing.view(), dt, Step::with(Coupling::automatic, known));
  EXPECT_EQ(forces.total, plain.flow.step(plain.packing.view(), dt).total);
  EXPECT_EQ(bed.flow.time(), dt);
}

TEST(AutomaticCoupling, TakesStagesNearTheLimitAndTheDenserFactorFarBeyond) {
  Bed bed;
  EXPECT_EQ(bed.chosen(2.0 * bed.limit()), Coupling::staged);
  EXPECT_GT(bed.flow.stages(), 1);
  EXPECT_EQ(bed.chosen(2000.0 * bed.limit()), Coupling::implicit);
  EXPECT_EQ(bed.flow.time(), 0.0);  // nothing was committed
}

TEST(AutomaticCoupling, WhatStandsAgainstLongStepsIsSaidWhereTheyAreNeeded) {
  Bed bed;
  const GrainDynamics known = bed.dynamics();
  Step step = Step::trial(Coupling::automatic, known);
  step.obstacle = "the host has no forces to tell";
  EXPECT_NO_THROW(bed.flow.advance(bed.packing.view(), 0.5 * bed.limit(), step));
  const double dt = 5.0 * bed.limit();
  expect_line(refusal([&] { bed.flow.advance(bed.packing.view(), dt, step); }), "no forces to tell");
  expect_line(refusal([&] {
                bed.flow.advance(bed.packing.view(), dt, {Coupling::staged, nullptr, true, 1.0, {}});
              }),
              "Step::dynamics");
}

TEST(TimeStepCheck, WarnsOfStepsBeyondTheLimitAndOfHeldPressuresBehindPistons) {
  Bed bed;
  std::vector<Piston> pistons(6);
  const auto check = [&](double ratio) {
    return check_time_step(bed.flow, bed.packing.view(), bed.masses, pistons,
                           ratio * bed.flow.time_step_limit(bed.masses, pistons));
  };
  EXPECT_TRUE(warnings_of(check(0.9), 1, 1.0, "").empty());
  EXPECT_EQ(warnings_of(check(0.9), 1, 0.8, "").size(), 1u);
  const auto beyond = warnings_of(check(2.0), 4, 1.0, ", or long steps");
  ASSERT_EQ(beyond.size(), 1u);
  EXPECT_NE(beyond[0].find("is 2 times the limit"), std::string::npos) << beyond[0];
  EXPECT_NE(beyond[0].find(", or long steps"), std::string::npos);
  Fluid water;
  water.bulk_modulus = 2e9;
  Bed sealed(water);
  pistons[5].mass = 1.0;
  const TimeStepCheck held =
      check_time_step(sealed.flow, sealed.packing.view(), sealed.masses, pistons, 1e-12);
  EXPECT_EQ(held.pistons, 1);
  EXPECT_EQ(warnings_of(held, 2, 1e9, "").size(), 1u);
  EXPECT_TRUE(warnings_of(held, 1, 1e9, "").empty());
}

/// Steps until the next solve, after `solves` of grains that keep still.
int interval_after(int solves, Fluid fluid, double step_of_limit) {
  Bed bed(fluid);
  bed.packing.velocities.setZero();
  const double step = step_of_limit * bed.limit();
  const std::vector<Piston> pistons(6);
  SolvePlan plan(1e-3);
  plan.restart();
  for (int solve = 0; solve < solves; ++solve) {
    const int steps = plan.next().steps;
    bed.flow.step(bed.packing.view(), steps * step);
    plan.take(bed.flow, {bed.packing.view(), bed.masses, pistons, steps, step, 0.0, 0.0, 0.01});
  }
  return plan.next().steps;
}

TEST(SolvePlan, WhereNothingChangesTheIntervalGrowsUpToTheLimit) {
  EXPECT_GT(interval_after(5, Fluid{}, 1e-6), 5);
  EXPECT_EQ(interval_after(20, Fluid{}, 0.09), 7);  // 0.7 of the limit, in whole steps
}

TEST(SolvePlan, NothingIsHeldInACompressibleFluid) {
  Fluid water;
  water.bulk_modulus = 2e9;
  EXPECT_EQ(interval_after(5, water, 1e-6), 1);
}

TEST(SolvePlan, AMotionThatTheLoadsFollowIsAJumpBeyondTenTolerances) {
  const NextSolve next{10, 0.0, 0.5, 1.0};
  EXPECT_FALSE(next.has_jumped(1.019, 1e-3));
  EXPECT_TRUE(next.has_jumped(1.021, 1e-3));
  EXPECT_TRUE(next.has_jumped(0.979, 1e-3));
}

TEST(SolvePlan, ChangesOfPressuresAreMeasuredByTheirDifferencesWhateverTheLevel) {
  for (const double level : {0.0, 101325.0}) {
    const Box then = ::support::pressure_box(Face::zlo, level + 100.0, Face::zhi, level, Wall::symmetry);
    Box now = then;
    EXPECT_EQ(change_of_imposed_values(now, then), 0.0);
    now[Face::zhi].boundary.value += 0.5;
    EXPECT_NEAR(change_of_imposed_values(now, then), 5e-3, 1e-12);
  }
}

TEST(SolvePlan, ChangesOfFluxesAreMeasuredByFluxesWhateverThePressures) {
  Box then = ::support::pressure_box(Face::zlo, 1e5, Face::zhi, 0.0, Wall::symmetry);
  then[Face::xlo].boundary = Boundary::flux(1e-5);
  Box now = then;
  now[Face::xlo].boundary.value = 1.1e-5;
  EXPECT_NEAR(change_of_imposed_values(now, then), 1.0 / 11.0, 1e-12);
}

TEST(SolvePlan, ACosineThatGrowsIsSeenWhereverItsZerosAre) {
  const auto wave = [](double amplitude, double shift, double half) {
    Box box = ::support::pressure_box(Face::zlo, 0.0, Face::zhi, 1000.0, Wall::symmetry);
    box[Face::zhi].boundary.profile = [=](const Eigen::Vector3d& place, double) {
      return 1000.0 + amplitude * std::cos(3.14159265358979 * (place.x() - shift) / half);
    };
    return box;
  };
  for (const double half : {0.01, 0.0625, 0.25, 1.0})  // of the box's side
    EXPECT_GT(change_of_imposed_values(wave(100.0, 0.5 * half, half), wave(0.0, 0.5 * half, half)), 0.08) << half;
}

TEST(SolvePlan, AWallIsAJumpByWhatTheFluidBearsAndFromRestAlways) {
  const NextSolve next{10, 0.0, 0.0, 0.0, 0.1};
  EXPECT_FALSE(next.walls_have_jumped(0.09, 1.0, 1e-3));
  EXPECT_TRUE(next.walls_have_jumped(0.11, 1.0, 1e-3));
  EXPECT_TRUE(NextSolve{}.walls_have_jumped(1e-9, 0.0, 1e-3));
  EXPECT_FALSE(NextSolve{}.walls_have_jumped(0.0, 0.0, 1e-3));
}

/// Of a bed between these pressures whose grains speed up: steps between the solves.
std::vector<int> intervals_at(double level) {
  Bed bed;
  bed.flow.set_container(::support::pressure_box(Face::zlo, level + 1.0, Face::zhi, level, Wall::symmetry));
  const double step = 1e-3 * bed.limit();
  const std::vector<Piston> pistons(6);
  SolvePlan plan(1e-3);
  plan.restart();
  std::vector<int> intervals;
  for (int solve = 0; solve < 15; ++solve) {
    const int steps = plan.next().steps;
    bed.packing.velocities *= 1.0 + 1e-2 * steps;
    bed.flow.step(bed.packing.view(), steps * step);
    plan.take(bed.flow, {bed.packing.view(), bed.masses, pistons, steps, step, 0.0, 0.0, 0.01});
    intervals.push_back(steps);
  }
  return intervals;
}

TEST(SolvePlan, AConstantInAllPressuresChangesNoInterval) { EXPECT_EQ(intervals_at(1024.0), intervals_at(0.0)); }

/// Steps until the next solve, eight solves after the pressure has jumped to threefold.
int interval_after_a_jump(bool told) {
  Bed bed;
  bed.packing.velocities.setZero();
  const double step = 1e-3 * bed.limit();
  const std::vector<Piston> pistons(6);
  SolvePlan plan(1e-3);
  plan.restart();
  for (int solve = 0; solve < 18; ++solve) {
    const bool jumps = solve == 10;
    if (jumps) bed.flow.set_container(::support::pressure_box(Face::zlo, 3.0, Face::zhi, 0.0, Wall::symmetry));
    const int steps = jumps ? 1 : plan.next().steps;
    bed.flow.step(bed.packing.view(), steps * step);
    plan.take(bed.flow, {bed.packing.view(), bed.masses, pistons, steps, step, 0.0, 0.0, 0.01, nullptr, jumps && told});
  }
  return plan.next().steps;
}

TEST(SolvePlan, AfterAJumpIntervalsBeginAnewAndTheOldLoadsAreForgotten) {
  EXPECT_LT(interval_after_a_jump(false), 5);
  EXPECT_GT(interval_after_a_jump(true), 20);
}
}  // namespace pfv

}  // namespace
}  // namespace automatic_coupling_test
