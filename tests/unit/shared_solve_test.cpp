// SPDX-License-Identifier: GPL-3.0-or-later
// Threads and the precision of the factor: what they may change, and what not.
#include "pfv/pfv.hpp"
#include "solve/linear_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace shared_solve_test {
namespace {

using namespace pfv;

/// Grains that sink between a fed and an open face, of enough pores that the elimination tree is cut.
struct Scene {
  Box box;
  PackingArrays packing = dense_packing(1500);

  Scene() {
    box[Face::zlo].boundary = Boundary::flux(1e-3);
    box[Face::zhi].boundary = Boundary::pressure(2.0);
    packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
    packing.velocities.row(2) = -1e-3 * packing.positions.row(2);
  }

  Flow flow(Precision precision, int threads) const {
    Options options;
    options.precision = precision;
    options.threads = threads;
    options.sphere_pressure = true;
    return Flow(box, Fluid{}, options);
  }
};

const Scene& scene() {
  static const Scene made;
  return made;
}

TEST(Threads, ChangeNoByte) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Flow alone = scene().flow(precision, 1);
    const Forces expected = alone.step(scene().packing.view(), 1e-3);
    for (const int threads : {2, 3, 7}) {
      Flow shared = scene().flow(precision, threads);
      const Forces& forces = shared.step(scene().packing.view(), 1e-3);
      EXPECT_EQ(shared.pore_pressures(), alone.pore_pressures()) << threads;
      EXPECT_EQ(forces.total, expected.total) << threads;
      EXPECT_EQ(forces.sphere_pressure, expected.sphere_pressure) << threads;
      EXPECT_EQ(shared.report().threads, threads);
    }
  }
}

TEST(MixedPrecision, IsGoodToItsTolerance) {
  Flow exact = scene().flow(Precision::full, 1), mixed = scene().flow(Precision::mixed, 1);
  for (int step = 0; step < 3; ++step) {
    const Forces expected = exact.step(scene().packing.view(), 1e-3);
    const Forces& forces = mixed.step(scene().packing.view(), 1e-3);
    EXPECT_LE(mixed.report().residual, 1e-9);
    const double largest = expected.total.cwiseAbs().maxCoeff();
    EXPECT_LT((forces.total - expected.total).cwiseAbs().maxCoeff(), 1e-9 * largest);
  }
}

// A new network begins without the old solution: a run that goes on and one that starts there agree.
TEST(MixedPrecision, RemembersNothingAcrossARebuild) {
  Flow flow = scene().flow(Precision::mixed, 1), fresh = scene().flow(Precision::mixed, 1);
  PackingArrays other = scene().packing;
  other.velocities *= -3.0;
  flow.step(other.view(), 1e-3);
  flow.rebuild();
  flow.step(scene().packing.view(), 1e-3);
  fresh.step(scene().packing.view(), 1e-3);
  EXPECT_EQ(flow.pore_pressures(), fresh.pore_pressures());
}

/// Pores that are all joined to one another, the first also to an imposed pressure by `tie`.
SymmetricMatrix cluster(int pores, double tie) {
  SymmetricMatrix matrix;
  for (int row = 0; row < pores; ++row) {
    double diagonal = row == 0 ? tie : 0.0;
    const std::size_t begin = matrix.value.size();
    for (int column = 0; column < pores; ++column) {
      const double conductance = column == row ? 0.0 : 1.0 + 0.3 * std::sin(1.0 + row * column);
      diagonal += conductance;
      matrix.column.push_back(column);
      matrix.value.push_back(-conductance);
    }
    matrix.value[begin + row] = diagonal;
    matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

// Rounding the factor hides what ties the pressures to 0.
TEST(MixedPrecision, SaysWhereItDoesNotSuffice) {
  const SymmetricMatrix matrix = cluster(50, 1e-8);
  const Eigen::VectorXd b = Eigen::VectorXd::Unit(50, 49);
  const auto exact = make_solver(SolverKind::supernodal, OrderingKind::amd);
  Options in_single_precision;
  in_single_precision.ordering = OrderingKind::amd;
  in_single_precision.precision = Precision::mixed;
  const auto mixed = make_solver(in_single_precision);
  Eigen::VectorXd x(50), y = Eigen::VectorXd::Zero(50);
  exact->order(matrix);
  exact->factor(matrix);
  exact->solve(b, x);
  EXPECT_LT((multiply(matrix, x) - b).norm(), 1e-4) << "solvable in double precision";
  mixed->order(matrix);
  mixed->factor(matrix);
  try {
    mixed->solve(b, y);
    ADD_FAILURE() << "residual " << (multiply(matrix, y) - b).norm();
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("use the precision double"), std::string::npos)
        << error.what();
  }
}

TEST(CheckOptions, RefusesThreadsAndPrecisionsThatMakeNoSense) {
  for (const int threads : {0, -1, 65}) {
    Options options;
    options.threads = threads;
    EXPECT_THROW(check(options), InputError) << threads;
  }
  Options options;
  options.precision = Precision::mixed;
  options.solver = SolverKind::klu2;
  EXPECT_THROW(check(options), InputError);
  EXPECT_EQ(named<Precision>(name_of(Precision::mixed)), Precision::mixed);
  EXPECT_EQ(named<Precision>(name_of(Precision::full)), Precision::full);
}

}  // namespace
}  // namespace shared_solve_test
