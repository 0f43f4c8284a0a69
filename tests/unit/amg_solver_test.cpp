// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients with algebraic multigrid: where they end, from where they set out, and that they agree with a
// factor on every kind of flow.
#include "solve/amg_solver.hpp"

#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/long_steps.hpp"
#include "support/matrices.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pfv {
namespace amg_solver_test {
namespace {

using namespace support;

Options solved_by(SolverKind solver, std::optional<double> tolerance = {}) {
  Options options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.retriangulation_strain = 1e9;
  return options;
}

PackingArrays moving(PackingArrays packing) {
  const Eigen::Index n = packing.positions.cols();
  Random random(5);
  packing.velocities.resize(3, n);
  for (Eigen::Index k = 0; k < n; ++k) packing.velocities.col(k) = random.in_cube(-0.1, 0.1);
  packing.velocities.row(2) -= packing.positions.row(2);
  return packing;
}

double rms(const Eigen::Matrix3Xd& forces) {
  return std::sqrt(forces.squaredNorm() / static_cast<double>(forces.cols()));
}

// ------------------------------------------------------------------------ the flows of a packing

struct Scene {
  const char* label;
  PackingArrays packing;
  Box box;
  Fluid fluid = viscosity_one();
};

std::vector<Scene> scenes() {
  const PackingArrays still = data_packing("packing_500.csv");
  Box fed = pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, Wall::symmetry);
  fed[Face::zlo].boundary = Boundary::flux(1e-3);  // its pores share one unknown: a row with hundreds of entries
  Box drained = fed;
  drained[Face::zlo].boundary = Boundary::sealed();
  Box periodic;
  periodic.periodic = {true, true, true};
  periodic.pressure_gradient = {1.0, 0.5, 0.0};
  std::vector<Scene> all{{"through", still, upward_box(Wall::no_slip)},
                         {"flux", still, fed},
                         {"moving", moving(still), drained},
                         {"compressible", moving(still), drained},
                         {"sealed and compressible", moving(still), Box{}},
                         {"periodic", data_packing("bed_periodic_64.csv"), periodic}};
  all[3].fluid.bulk_modulus = all[4].fluid.bulk_modulus = 1e3;
  return all;
}

// Measured: the rms error of the forces is 0.02 to 0.6 of the tolerance; 2.5 in the periodic cell, whose 64 spheres
// have few pores over which errors would cancel.
TEST(Amg, ForcesAgreeWithThoseOfAFactorToTheTolerance) {
  for (const Scene& scene : scenes()) {
    Flow exact(scene.box, scene.fluid, solved_by(SolverKind::supernodal));
    const Eigen::Matrix3Xd forces = exact.step(scene.packing.view(), 1e-3).total;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      Flow flow(scene.box, scene.fluid, solved_by(SolverKind::amg, tolerance));
      const Eigen::Matrix3Xd found = flow.step(scene.packing.view(), 1e-3).total;
      EXPECT_LE(rms(found - forces), 3.0 * tolerance * rms(forces)) << scene.label << ' ' << tolerance;
      EXPECT_EQ(flow.report().counts.factor, 1);
      EXPECT_EQ(flow.report().counts.solve, 1);
      EXPECT_EQ(flow.report().solver, "amg");
    }
  }
}

TEST(Amg, BalancesCloseAtItsOwnTolerance) {
  for (const Scene& scene : scenes()) {
    Flow flow(scene.box, scene.fluid, solved_by(SolverKind::amg));
    flow.step(scene.packing.view(), 1e-3);
    EXPECT_LE(std::abs(flow.report().mass_error), 1e-11) << scene.label;
    EXPECT_LE(flow.report().force_balance_error, 1e-12) << scene.label;
  }
}

TEST(Amg, AHierarchyServesAllStepsOnANetworkAndRunsRepeatTheirBytes) {
  for (const Scene& scene : scenes()) {
    const Options options = solved_by(SolverKind::amg);
    Flow first(scene.box, scene.fluid, options), second(scene.box, scene.fluid, options);
    PackingArrays packing = scene.packing;
    for (int step = 0; step < 12; ++step) {
      packing.velocities *= 1.01;
      const Eigen::Matrix3Xd forces = first.step(packing.view(), 1e-3).total;
      EXPECT_EQ(forces, second.step(packing.view(), 1e-3).total) << scene.label << ' ' << step;
    }
    EXPECT_EQ(first.report().counts.order, 1);
    EXPECT_EQ(first.report().counts.factor, 1);
    EXPECT_EQ(first.report().counts.solve, 12);
  }
}

TEST(Amg, ANewTimeStepOfACompressibleFluidBuildsAHierarchyOnTheOldPattern) {
  const Scene scene = scenes()[3];
  Flow exact(scene.box, scene.fluid, solved_by(SolverKind::supernodal));
  Flow flow(scene.box, scene.fluid, solved_by(SolverKind::amg, 1e-9));
  for (const double dt : {1e-3, 1e-3, 1e-2}) {
    const Eigen::Matrix3Xd forces = exact.step(scene.packing.view(), dt).total;
    EXPECT_LE(rms(flow.step(scene.packing.view(), dt).total - forces), 1e-8 * rms(forces));
  }
  EXPECT_EQ(flow.report().counts.order, 1);
  EXPECT_EQ(flow.report().counts.factor, 2);
}

TEST(Amg, StagedStepsAndTheirLimitAgreeWithThoseOfAFactor) {
  PackingArrays packing = moving(data_packing("packing_100.csv"));
  const Eigen::Index n = packing.positions.cols();
  const Eigen::VectorXd masses = 4.0 / 3.0 * pi * packing.radii.array().cube();
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, n);
  const GrainDynamics dynamics{{masses.data(), n}, {none.data(), 3, n}};
  const Box box = scenes()[2].box;
  Flow exact(box, viscosity_one(), solved_by(SolverKind::supernodal));
  Flow flow(box, viscosity_one(), solved_by(SolverKind::amg, 1e-8));
  exact.evaluate(packing.view());
  flow.evaluate(packing.view());
  const double limit = exact.time_step_limit(masses);
  EXPECT_NEAR(flow.time_step_limit(masses) / limit, 1.0, 1e-6);
  for (int step = 0; step < 3; ++step) {
    const Eigen::Matrix3Xd forces = step_staged(exact, packing.view(), 20.0 * limit, dynamics).total;
    EXPECT_LE(rms(step_staged(flow, packing.view(), 20.0 * limit, dynamics).total - forces), 1e-6 * rms(forces));
  }
  EXPECT_GT(flow.stages(), 3);
}

// Conductances over some nine decades.
TEST(Amg, TakesSpheresOfFiftyTimesTheSize) {
  std::vector<Sphere> spheres;
  const PackingArrays bed = data_packing("packing_100.csv");
  for (Eigen::Index k = 0; k < bed.radii.size(); ++k)
    spheres.push_back({bed.positions(0, k), bed.positions(1, k), bed.positions(2, k), bed.radii[k]});
  Random random(3);
  const auto is_free = [&](const Eigen::Vector3d& place, double radius) {
    for (const Sphere& s : spheres)
      if ((place - Eigen::Vector3d(s.x, s.y, s.z)).norm() < s.radius + radius) return false;
    return true;
  };
  const double fine = bed.radii.mean() / 50.0;
  while (spheres.size() < 600)
    if (const Eigen::Vector3d place = random.in_cube(fine, 1.0 - fine); is_free(place, fine))
      spheres.push_back({place[0], place[1], place[2], fine});
  const PackingArrays packing = packing_of(spheres);
  const Box box = upward_box(Wall::no_slip);
  Flow exact(box, viscosity_one()), flow(box, viscosity_one(), solved_by(SolverKind::amg, 1e-8));
  const Eigen::Matrix3Xd forces = exact.evaluate(packing.view()).total;
  EXPECT_LE(rms(flow.evaluate(packing.view()).total - forces), 1e-8 * rms(forces));
}

// -------------------------------------------------------------------------------------- matrices

/// Cold, with its iterations.
int iterations_on(const SymmetricMatrix& matrix, double tolerance) {
  AmgSolver solver(tolerance);
  const Eigen::VectorXd b = right_side(matrix.size());
  solution(solver, matrix, b);
  return solver.iterations();
}

TEST(Amg, IterationsHardlyGrowWithTheNumberOfPores) {
  const int few = iterations_on(lattice(8), 1e-8), many = iterations_on(lattice(24), 1e-8);
  EXPECT_LE(many, few + 6);
  EXPECT_LE(many, 25);
}

// Of the flow through the pores, not of b.
TEST(Amg, EndsAtTheMassDefectThatTheToleranceSays) {
  const SymmetricMatrix matrix = lattice(10, 1e4);  // throats to imposed pressures wide open: |b| is beside the point
  Eigen::VectorXd b = Eigen::VectorXd::Zero(matrix.size());
  for (int row = 0; row < matrix.size() / 10; ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) b[row] += matrix.value[k];
  double last = 1.0;
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    AmgSolver solver(tolerance);
    const Eigen::VectorXd x = solution(solver, matrix, b);
    double defect = 0.0, flow = 0.0;
    for (int row = 0; row < matrix.size(); ++row) {
      double product = 0.0, sum = 0.0, throats = 0.0;
      for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
        product += matrix.value[k] * x[matrix.column[k]];
        sum += matrix.value[k];
        throats += std::abs(matrix.value[k] * (x[matrix.column[k]] - x[row]));
      }
      defect += std::pow(b[row] - product, 2);
      flow += 0.25 * std::pow(throats + std::abs(b[row] - sum * x[row]), 2);
    }
    EXPECT_LE(std::sqrt(defect / flow), 1.1 * tolerance + 1e-11);
    EXPECT_LT(std::sqrt(defect / flow), last);
    last = std::sqrt(defect / flow);
  }
  EXPECT_GT(last, 1e-12);  // no further than asked for
}

TEST(Amg, SetsOutFromTheLastSolutions) {
  const SymmetricMatrix matrix = lattice(12);
  const int n = matrix.size();
  const auto right_side_at = [&](double t) -> Eigen::VectorXd {
    return Eigen::VectorXd::LinSpaced(n, 1.0, 3.0).unaryExpr(
        [t](double s) { return std::sin(s + t) + t * std::cos(7.0 * s); });
  };
  AmgSolver solver(1e-8), alone(1e-8, 0);
  Eigen::VectorXd x, y;
  int with = 0, without = 0;
  for (AmgSolver* each : {&solver, &alone}) {
    each->order(matrix, {});
    each->factor(matrix);
  }
  for (int step = 0; step < 12; ++step) {
    solver.solve(right_side_at(0.01 * step), x);
    alone.solve(right_side_at(0.01 * step), y);
    if (step < 4) continue;
    with += solver.iterations();
    without += alone.iterations();
  }
  EXPECT_LT(with, without / 2);
  EXPECT_LE((x - y).norm(), 1e-6 * y.norm());
  x.setZero();  // a new sequence
  solver.solve(right_side_at(0.0), x);
  Eigen::VectorXd z;
  alone.solve(right_side_at(0.0), z);
  EXPECT_EQ(x, z);
}

// A fix looks at a step once more where it writes a restart file.
TEST(Amg, SolvingTwiceChangesNothingInWhatFollows) {
  const SymmetricMatrix matrix = lattice(10);
  AmgSolver once(1e-7), twice(1e-7);
  Eigen::VectorXd x, y;
  for (AmgSolver* each : {&once, &twice}) {
    each->order(matrix, {});
    each->factor(matrix);
  }
  for (int step = 0; step < 6; ++step) {
    const Eigen::VectorXd b = right_side(matrix.size()).array().pow(1.0 + 0.1 * step);
    once.solve(b, x);
    twice.solve(b, y);
    twice.solve(b, y);
    EXPECT_EQ(twice.iterations(), 0);
    EXPECT_EQ(x, y) << step;
  }
}

TEST(Amg, AnotherUnitChangesNoDigit) {
  SymmetricMatrix matrix = lattice(6);
  const Eigen::VectorXd b = right_side(matrix.size());
  AmgSolver solver(1e-8);
  const Eigen::VectorXd x = solution(solver, matrix, b);
  for (const int power : {-80, 80}) {
    SymmetricMatrix scaled = matrix;
    for (double& value : scaled.value) value = std::ldexp(value, power);
    AmgSolver other(1e-8);
    EXPECT_EQ(solution(other, scaled, b) * std::ldexp(1.0, power), x) << power;
  }
}

/// Two lines of pores, one of them tied to a pressure by the other's end alone, `weak` times as wide as the rest.
SymmetricMatrix behind_a_narrow_throat(double weak) {
  Rows rows(40);
  for (int i = 0; i + 1 < 40; ++i) connect(rows, i, i + 1, i == 19 ? weak : 1.0);
  rows[0][0] += 1.0;
  return compressed(rows);
}

TEST(Amg, FindsThePressuresBehindNarrowThroats) {
  for (const double weak : {1e-4, 1e-8, 1e-10}) {
    const SymmetricMatrix matrix = behind_a_narrow_throat(weak);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(40);
    b[5] = 1.0;   // 6 Pa from pore 5 on
    b[25] = 1.0;  // flows within the second line and out of it again
    b[35] = -1.0;
    AmgSolver solver(1e-6);
    const Eigen::VectorXd x = solution(solver, matrix, b);
    EXPECT_NEAR(x[19], 6.0, 1e-4) << weak;
    EXPECT_NEAR(x[20], 6.0, 1e-4) << weak;
    EXPECT_NEAR(x[39], -4.0, 1e-4) << weak;
  }
}

TEST(Amg, RefusesPressuresThatNothingHolds) {
  const SymmetricMatrix matrix = behind_a_narrow_throat(1e-18);  // lost beside 1
  AmgSolver solver(1e-6);
  const std::string message = message_of<SolverError>([&] { solution(solver, matrix, right_side(40)); });
  EXPECT_TRUE(contains(message, "nothing determines the pressure of a group")) << message;
}

// Rounding leaves some sixteen digits of the largest pressure.
TEST(Amg, EndsAtRoundingWhereTheToleranceAsksForMore) {
  const SymmetricMatrix matrix = lattice(10);
  const Eigen::VectorXd b = right_side(matrix.size());
  AmgSolver solver(1e-15);
  EXPECT_LE(residual(matrix, solution(solver, matrix, b), b), 1e-12);
  EXPECT_LT(solver.iterations(), 60);
}

// --------------------------------------------------------------------------------------- refusals

std::string refused(const std::function<void(Options&)>& change, Coupling coupling = Coupling::explicit_step) {
  Options options = solved_by(SolverKind::amg);
  change(options);
  return refusal([&] { check(options, coupling); });
}

TEST(Amg, WhatItCannotDoIsRefusedInOneLine) {
  const auto nothing = [](Options&) {};
  expect_line(refused([](Options& o) { o.ordering = OrderingKind::metis; }), "the solver amg takes no ordering metis");
  expect_line(refused([](Options& o) { o.precision = Precision::mixed; }),
              "the solver amg takes no choice of precision");
  expect_line(refused([](Options& o) { o.tolerance = 0.0; }), "tolerance");
  expect_line(refused(nothing, Coupling::implicit), "the solver amg solves no implicit steps");
  Options by;
  by.solver = SolverKind::amg;
  EXPECT_NO_THROW(check(by, Coupling::automatic));
}
}  // namespace pfv

}  // namespace
}  // namespace amg_solver_test
