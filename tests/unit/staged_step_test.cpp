// SPDX-License-Identifier: GPL-3.0-or-later
// Staged (Runge-Kutta-Chebyshev) coupling: grains that only the fluid brakes.
#include "pfv/pfv.hpp"
#include "physics/chebyshev_stages.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "pfv/dense_packing.hpp"

#include <cmath>
#include <limits>
#include <gtest/gtest.h>

namespace pfv {
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

  Braked() : flow(drained(), Fluid{}) {
    masses = 2600.0 * 4.0 / 3.0 * 3.14159265358979 * packing.radii.array().cube();
    none = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
    std::srand(7);
    packing.velocities = 1e-9 * Eigen::Matrix3Xd::Random(3, packing.ids.size());
    flow.evaluate(packing.view());
  }
  double limit() { return flow.time_step_limit(masses); }
  double energy() const {
    return (masses.array() * packing.velocities.colwise().squaredNorm().transpose().array()).sum();
  }
  GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  }
  void move(const Eigen::Matrix3Xd& force, double dt) {
    packing.velocities.array() += dt * (force.array().rowwise() / masses.transpose().array());
  }
};

TEST(StagedStep, ExplicitStepGrowsBeyondTheLimitAndStagedStepDoesNot) {
  Braked explicit_run, staged_run;
  const double dt = 20.0 * explicit_run.limit(), start = explicit_run.energy();
  for (int step = 0; step < 10; ++step)
    explicit_run.move(explicit_run.flow.step(explicit_run.packing.view(), dt).total, dt);
  EXPECT_GT(explicit_run.energy(), 1e6 * start);

  for (const double ratio : {20.0, 100.0}) {
    Braked run;
    double last = run.energy();
    for (int step = 0; step < 10; ++step) {
      run.move(run.flow.step_staged(run.packing.view(), ratio * run.limit(), run.dynamics()).total,
               ratio * run.limit());
      EXPECT_LT(run.energy(), last) << ratio;
      last = run.energy();
    }
    EXPECT_GT(run.flow.stages(), 1);
  }
}

TEST(StagedStep, StableAtAThousandTimesTheLimit) {
  // The papers' S is not the transpose of E: in a few modes the fluid feeds energy, some 1e-5 of it
  // a step and limit (1 % a step here), which contacts hide. Of the rest, motions that squeeze no pore
  // keep their energy: 0.31 of the start is left, where the explicit step would have 1e33 times more.
  Braked run;
  const double start = run.energy();
  for (int step = 0; step < 10; ++step)
    run.move(run.flow.step_staged(run.packing.view(), 1000.0 * run.limit(), run.dynamics()).total,
             1000.0 * run.limit());
  EXPECT_LT(run.energy(), 0.32 * start);
}

/// Spheres that overlap by most of their radii: S is far from a transpose of E there, and the fluid feeds
/// energy to motions at any time step.
struct Feeding {
  PackingArrays packing = ::support::packing_of({{0.6507, 0.3026, 0.1932, 0.2143},
                                                 {0.6943, 0.4208, 0.1098, 0.0217},
                                                 {0.6891, 0.4254, 0.1112, 0.0077},
                                                 {0.4010, 0.8096, 0.8564, 0.3704},
                                                 {0.6915, 0.3145, 0.5260, 0.1190},
                                                 {0.7036, 0.2893, 0.5440, 0.0857}});
  Eigen::VectorXd masses = 4e3 * packing.radii.array().cube();
  Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, masses.size());
  Flow flow{::support::upward_box(Wall::symmetry), ::support::viscosity_one()};
  double limit;

  Feeding() {
    packing.velocities = Eigen::Matrix3Xd::Zero(3, masses.size());
    packing.velocities.row(2) = -0.1 * packing.positions.row(2);
    flow.evaluate(packing.view());
    limit = flow.time_step_limit(masses);
  }
  GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  }
};

TEST(StagedStep, ThatGoesOutOfControlIsRefusedAndTheImplicitOneTakesItsPlace) {
  Feeding grains;
  const double dt = 1e3 * grains.limit;
  try {
    grains.flow.step_staged(grains.packing.view(), dt, grains.dynamics());
    FAIL() << "not refused";
  } catch (const UnstableStep& error) {
    ::support::expect_line(error.what(), "1e+03 limits");
    ::support::expect_line(error.what(), "sphere 2");
    ::support::expect_line(error.what(), "implicit");
  }
  EXPECT_EQ(grains.flow.time(), 0.0);
  grains.flow.step_implicit(grains.packing.view(), dt, grains.dynamics());
  EXPECT_EQ(grains.flow.time(), dt);
  // the imposed 1 Pa and the grains' own inertia
  EXPECT_LT(grains.flow.pore_pressures().cwiseAbs().maxCoeff(), 1.2);
  EXPECT_LT(std::abs(grains.flow.report().mass_error), 1e-9);
}

TEST(StagedStep, OfTheSamePackingAtTenLimitsKeepsItsBound) {
  Feeding grains;
  grains.flow.step_staged(grains.packing.view(), 10.0 * grains.limit, grains.dynamics());
  EXPECT_GT(grains.flow.stages(), 1);
}

TEST(StagedStep, BelowTheLimitItIsThePlainStep) {
  Braked plain, staged;
  const double dt = 0.5 * plain.limit();
  const Eigen::Matrix3Xd a = plain.flow.step(plain.packing.view(), dt).total;
  const Eigen::Matrix3Xd b =
      staged.flow.step_staged(staged.packing.view(), dt, staged.dynamics()).total;
  EXPECT_EQ(a, b);
  EXPECT_EQ(staged.flow.stages(), 1);
}

TEST(StagedStep, EvaluatingItAdvancesNothing) {
  Braked run;
  const double dt = 50.0 * run.limit();
  const Eigen::Matrix3Xd evaluated =
      run.flow.evaluate_staged(run.packing.view(), dt, run.dynamics()).total;
  EXPECT_GT(run.flow.stages(), 1);
  EXPECT_EQ(run.flow.time(), 0.0);
  EXPECT_EQ(run.flow.strain(), 0.0);
  EXPECT_EQ(run.flow.step_staged(run.packing.view(), dt, run.dynamics()).total, evaluated);
  EXPECT_EQ(run.flow.time(), dt);
}

TEST(StagedStep, ForcesAndVolumesOfTheStepBalance) {
  Braked run;
  run.flow.step_staged(run.packing.view(), 50.0 * run.limit(), run.dynamics());
  const Report report = run.flow.report();
  EXPECT_LT(std::abs(report.mass_error), 1e-14);
  EXPECT_LT(report.force_balance_error, 1e-13);
}

TEST(StagedStep, FirstOrderTowardsTheFineExplicitSolution) {
  // velocities after 4 limits of time: staged steps of 4 and 2 limits against explicit ones of 1/64
  const auto velocities = [](double ratio, bool staged) {
    Braked run;
    const double limit = run.limit();
    for (int step = 0; step < static_cast<int>(std::lround(4.0 / ratio)); ++step) {
      const double dt = ratio * limit;
      run.move(staged ? run.flow.step_staged(run.packing.view(), dt, run.dynamics()).total
                      : run.flow.step(run.packing.view(), dt).total,
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
      run.flow.step_staged(run.packing.view(), dt, run.dynamics()).total;
  EXPECT_TRUE(force.allFinite());
  EXPECT_GT(force.col(3).norm(), 0.0);
}

TEST(StagedStep, RefusesMissingForces) {
  Braked run;
  GrainDynamics dynamics{{run.masses.data(), run.masses.size()}, {nullptr, 3, 0}};
  EXPECT_THROW(run.flow.step_staged(run.packing.view(), 1.0, dynamics), InputError);
}

}  // namespace
}  // namespace pfv
