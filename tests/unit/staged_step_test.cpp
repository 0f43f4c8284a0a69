// SPDX-License-Identifier: GPL-3.0-or-later
// Staged (Runge-Kutta-Chebyshev) coupling: grains that only the fluid brakes.
#include "pfv/pfv.hpp"
#include "physics/chebyshev_stages.hpp"
#include "support/long_steps.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "pfv/dense_packing.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <gtest/gtest.h>

namespace pfv {
namespace staged_step_test {
namespace {

Box drained() {
  return ::support::pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, Wall::symmetry);
}

/// y' = -lambda y over one step dt with z = dt lambda, relative to y_0.
double growth(double z, double fraction) {
  double before = 1.0, now = 1.0;
  for (const ChebyshevStage& stage : chebyshev_stages(z)) {
    const double next = (1.0 - stage.m - stage.n) + stage.m * now + stage.n * before +
                        stage.f * (-z * fraction * now);
    before = now;
    now = next;
  }
  return now;
}

TEST(ChebyshevStages, OneStageIsExplicitEuler) {
  const auto stages = chebyshev_stages(1.0);
  ASSERT_EQ(stages.size(), 1u);
  EXPECT_DOUBLE_EQ(growth(1.0, 0.25), 0.75);
}

TEST(ChebyshevStages, EveryEigenvalueUpToTheLargestIsDamped) {
  for (const double z : {2.5, 10.0, 100.0, 1000.0, 2e4})
    for (int i = 1; i <= 1000; ++i) EXPECT_LT(std::abs(growth(z, i / 1000.0)), 1.0) << z << ' ' << i;
}

TEST(ChebyshevStages, FirstOrderConsistent) {
  // y(dt) = 1 - x + O(x²) for an eigenvalue x far below the largest
  for (const double z : {10.0, 1000.0}) {
    const double x = 1e-5;
    EXPECT_NEAR((1.0 - growth(z, x / z)) / x, 1.0, 2.0 * x) << z;
  }
}

TEST(ChebyshevStages, StagesGrowLikeTheSquareRoot) {
  // 1.5 to 1.6 sqrt(R) for R = z / 2 (Verwer 1996 with epsilon = 2), small R rounded up
  for (const double ratio : {10.0, 100.0, 1000.0})
    EXPECT_NEAR(static_cast<double>(chebyshev_stages(2.0 * ratio).size()) / std::sqrt(ratio), 1.56,
                0.15);
}

/// Grains with random velocities, braked by the fluid alone; positions stay (their displacement over
/// the test is negligible). Kinetic energy after `steps`, relative to the start.
struct Braked {
  PackingArrays packing = dense_packing(60);
  Eigen::VectorXd masses;
  Eigen::Matrix3Xd none;
  Flow flow;

  static Options with_torques() {
    Options options;
    options.torques = true;
    return options;
  }
  Braked() : flow(drained(), Fluid{}, with_torques()) {
    masses = 2600.0 * 4.0 / 3.0 * 3.14159265358979 * packing.radii.array().cube();
    none = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
    std::srand(7);
    packing.velocities = 1e-9 * Eigen::Matrix3Xd::Random(3, packing.ids.size());
    packing.angular_velocities = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
    flow.evaluate(packing.view());
  }
  double limit() { return flow.time_step_limit(masses); }
  double energy() const {
    return (masses.array() * packing.velocities.colwise().squaredNorm().transpose().array()).sum() +
           (inertias().array() *
            packing.angular_velocities.colwise().squaredNorm().transpose().array()).sum();
  }
  Eigen::VectorXd inertias() const {
    return 0.4 * masses.array() * packing.radii.array().square();
  }
  GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  }
  void move(const Forces& forces, double dt) {
    packing.velocities.array() += dt * (forces.total.array().rowwise() / masses.transpose().array());
    packing.angular_velocities.array() +=
        dt * (forces.torque.array().rowwise() / inertias().transpose().array());
  }
};

TEST(StagedStep, ExplicitStepGrowsBeyondTheLimitAndStagedStepDoesNot) {
  Braked explicit_run;
  const double dt = 20.0 * explicit_run.limit(), start = explicit_run.energy();
  for (int step = 0; step < 10; ++step)
    explicit_run.move(explicit_run.flow.step(explicit_run.packing.view(), dt), dt);
  EXPECT_GT(explicit_run.energy(), 1e6 * start);

  Braked run;
  double last = run.energy();
  for (int step = 0; step < 10; ++step) {
    run.move(support::step_staged(run.flow, run.packing.view(), dt, run.dynamics()), dt);
    EXPECT_LT(run.energy(), last);
    last = run.energy();
  }
  EXPECT_GT(run.flow.stages(), 1);
}

TEST(StagedStep, NoMotionIsFedHoweverLongTheStepIs) {
  for (const double ratio : {100.0, 1000.0, 1e4}) {
    Braked run;
    const double dt = ratio * run.limit();
    double last = run.energy();
    for (int step = 0; step < 40; ++step) {
      run.move(support::step_staged(run.flow, run.packing.view(), dt, run.dynamics()), dt);
      EXPECT_LE(run.energy(), last) << ratio << ' ' << step;
      last = run.energy();
    }
  }
}

/// Spheres that overlap by most of their radii.
struct Overlapping {
  PackingArrays packing = ::support::packing_of(
      {{0.6377, 0.1333, 0.7586, 0.2961}, {0.6431, 0.1482, 0.7321, 0.2363},
       {0.5018, 0.123, 0.8088, 0.0464}, {0.4895, 0.1208, 0.819, 0.016},
       {0.4887, 0.1203, 0.8199, 0.0147}, {0.4872, 0.1217, 0.8189, 0.011},
       {0.487, 0.1233, 0.8172, 0.0076}, {0.4852, 0.1217, 0.8194, 0.0029},
       {0.2171, 0.7767, 0.8685, 0.3991}, {0.106, 0.642, 0.9215, 0.1346},
       {0.1642, 0.5968, 0.9395, 0.0384}, {0.1744, 0.6001, 0.9283, 0.0196},
       {0.172, 0.6078, 0.9281, 0.0105}, {0.1722, 0.6004, 0.9311, 0.0028},
       {0.1724, 0.6001, 0.9317, 0.0014}, {0.7521, 0.7455, 0.4635, 0.2457}});
  Eigen::VectorXd masses = 4e3 * packing.radii.array().cube();
  Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, masses.size());
};

// With the papers' volume rates the fluid drove these on at any time step.
TEST(StagedStep, OverlapsByMostOfTheRadiiAreBraked) {
  for (const double ratio : {23.0, 1000.0}) {
    Overlapping grains;
    Flow flow(::support::pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, Wall::no_slip),
              ::support::viscosity_one(), Braked::with_torques());
    Eigen::Matrix3Xd& v = grains.packing.velocities;
    v = Eigen::Matrix3Xd::Zero(3, grains.masses.size());
    v.row(2) = -1e-9 * grains.packing.positions.row(2);
    grains.packing.angular_velocities = grains.none;
    flow.evaluate(grains.packing.view());
    const double dt = ratio * flow.time_step_limit(grains.masses);
    const auto energy = [&] {
      return (grains.masses.array() * v.colwise().squaredNorm().transpose().array()).sum();
    };
    const double start = energy();
    for (int step = 0; step < 20; ++step) {
      const Forces& forces = support::step_staged(
          flow, grains.packing.view(), dt,
          {{grains.masses.data(), grains.masses.size()}, {grains.none.data(), 3, grains.none.cols()}});
      for (int k = 0; k < v.cols(); ++k) {
        v.col(k) += dt / grains.masses[k] * forces.total.col(k);
        grains.packing.angular_velocities.col(k) +=
            dt / (0.4 * grains.masses[k] * std::pow(grains.packing.radii[k], 2)) *
            forces.torque.col(k);
      }
    }
    EXPECT_LT(energy(), 1.001 * start) << ratio;
  }
}

TEST(StagedStep, BelowTheLimitItIsThePlainStep) {
  Braked plain, staged;
  const double dt = 0.5 * plain.limit();
  const Eigen::Matrix3Xd a = plain.flow.step(plain.packing.view(), dt).total;
  const Eigen::Matrix3Xd b =
      support::step_staged(staged.flow, staged.packing.view(), dt, staged.dynamics()).total;
  EXPECT_EQ(a, b);
  EXPECT_EQ(staged.flow.stages(), 1);
}

TEST(StagedStep, EvaluatingItAdvancesNothing) {
  Braked run;
  const double dt = 50.0 * run.limit();
  const Eigen::Matrix3Xd evaluated =
      support::try_staged(run.flow, run.packing.view(), dt, run.dynamics()).total;
  EXPECT_GT(run.flow.stages(), 1);
  EXPECT_EQ(run.flow.time(), 0.0);
  EXPECT_EQ(run.flow.strain(), 0.0);
  EXPECT_EQ(support::step_staged(run.flow, run.packing.view(), dt, run.dynamics()).total, evaluated);
  EXPECT_EQ(run.flow.time(), dt);
}

TEST(StagedStep, ForcesAndVolumesOfTheStepBalance) {
  Braked run;
  support::step_staged(run.flow, run.packing.view(), 50.0 * run.limit(), run.dynamics());
  const Report report = run.flow.report();
  EXPECT_LT(std::abs(report.mass_error), 2e-14);  // round-off of a dozen stages
  EXPECT_LT(report.force_balance_error, 1e-13);
}

TEST(StagedStep, FirstOrderTowardsTheFineExplicitSolution) {
  // velocities after 4 limits of time: staged steps of 4 and 2 limits against explicit ones of 1/64
  const auto velocities = [](double ratio, bool staged) {
    Braked run;
    const double limit = run.limit();
    for (int step = 0; step < static_cast<int>(std::lround(4.0 / ratio)); ++step) {
      const double dt = ratio * limit;
      run.move(staged ? support::step_staged(run.flow, run.packing.view(), dt, run.dynamics())
                      : run.flow.step(run.packing.view(), dt),
               dt);
    }
    return run.packing.velocities;
  };
  const Eigen::Matrix3Xd fine = velocities(1.0 / 64, false);
  const double coarse_error = (velocities(4.0, true) - fine).norm() / fine.norm();
  const double half_error = (velocities(2.0, true) - fine).norm() / fine.norm();
  EXPECT_LT(half_error, 0.75 * coarse_error);
  EXPECT_LT(coarse_error, 0.2);
}

TEST(StagedStep, AGrainOfInfiniteMassKeepsItsVelocity) {
  Braked run;
  run.masses[3] = std::numeric_limits<double>::infinity();
  const double dt = 50.0 * run.limit();
  const Eigen::Matrix3Xd force =
      support::step_staged(run.flow, run.packing.view(), dt, run.dynamics()).total;
  EXPECT_TRUE(force.allFinite());
  EXPECT_GT(force.col(3).norm(), 0.0);
}

TEST(StagedStep, RefusesMissingForces) {
  Braked run;
  GrainDynamics dynamics{{run.masses.data(), run.masses.size()}, {nullptr, 3, 0}};
  EXPECT_THROW(support::step_staged(run.flow, run.packing.view(), 1.0, dynamics), InputError);
}
}  // namespace pfv

}  // namespace
}  // namespace staged_step_test
