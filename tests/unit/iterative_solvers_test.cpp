// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "solve/linear_solver.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <ostream>
#include <string>

namespace pfv {

static void PrintTo(SolverKind kind, std::ostream* stream) { *stream << name_of(kind); }

namespace iterative_solvers_test {
namespace {

using namespace support;

void expect_refusal_of_row_4(SolverKind kind, double diagonal) {
  Rows rows = line(6);
  rows[4][4] = diagonal;
  const SymmetricMatrix matrix = compressed(rows);
  const auto solver = make_solver(kind, OrderingKind::automatic);
  solver->order(matrix);
  const std::string message = message_of<SolverError>([&] { solver->factor(matrix); });
  EXPECT_TRUE(contains(message, "not positive definite at row 4")) << message;
}

TEST(ConjugateGradient, NamesTheRowThatIsNotPositive) {
  expect_refusal_of_row_4(SolverKind::cg, 0.1);
}

TEST(GaussSeidel, NamesTheRowThatIsNotPositive) {
  expect_refusal_of_row_4(SolverKind::gauss_seidel, 0.0);
}

class IterativeSolver : public testing::TestWithParam<SolverKind> {};
INSTANTIATE_TEST_SUITE_P(Solvers, IterativeSolver,
                         testing::Values(SolverKind::amg, SolverKind::cg, SolverKind::gauss_seidel),
                         [](const auto& info) { return std::string(name_of(info.param)); });

/// Those whose tolerance is of the right-hand side; amg's: amg_solver_test.cpp.
class ResidualOfSolver : public testing::TestWithParam<SolverKind> {};
INSTANTIATE_TEST_SUITE_P(Solvers, ResidualOfSolver, testing::Values(SolverKind::cg, SolverKind::gauss_seidel),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(ResidualOfSolver, EndsWhereTheToleranceSays) {
  const SymmetricMatrix matrix = lattice(8, 0.1);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(matrix.size(), -1.0, 2.0);
  double last = 1.0;
  for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
    Options options;
    options.solver = GetParam();
    options.tolerance = tolerance;
    const auto solver = make_solver(options);
    const double residual = (b - multiply(matrix, solution(*solver, matrix, b))).norm() / b.norm();
    EXPECT_LE(residual, tolerance);
    EXPECT_LT(residual, last);
    last = residual;
  }
  EXPECT_GT(last, 1e-14);  // no further than asked for
}

// The sum of the sources has nowhere to go.
TEST_P(IterativeSolver, SaysThatItFoundNoSolution) {
  const SymmetricMatrix matrix = lattice(4, 0.0);
  const auto solver = make_solver(GetParam(), OrderingKind::automatic);
  const std::string message = message_of<SolverError>(
      [&] { solution(*solver, matrix, Eigen::VectorXd::Ones(matrix.size())); });
  EXPECT_TRUE(contains(message, "no solution after") ||
              contains(message, "not positive definite")) << message;
}

TEST_P(IterativeSolver, TakesNoOrdering) {
  for (const OrderingKind ordering :
       {OrderingKind::geometric, OrderingKind::metis, OrderingKind::amd}) {
    EXPECT_THROW(make_solver(GetParam(), ordering), InputError);
  }
}

TEST_P(IterativeSolver, GivesZeroForZero) {
  const auto solver = make_solver(GetParam(), OrderingKind::automatic);
  EXPECT_TRUE(solution(*solver, lattice(4), Eigen::VectorXd::Zero(64)).isZero(0.0));
}
}  // namespace pfv

}  // namespace
}  // namespace iterative_solvers_test
