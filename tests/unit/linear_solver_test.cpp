// SPDX-License-Identifier: GPL-3.0-or-later
// What every solver must be able to do, and to refuse.
#include "solve/linear_solver.hpp"

#include "pfv/error.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>

namespace pfv {
namespace linear_solver_test {
namespace {

using namespace support;

struct Choice {
  SolverKind solver;
  OrderingKind ordering;
  const char* label;
  double residual = 0.0;  ///< that an iterative solver may leave
  std::optional<double> tolerance = {};
};

void PrintTo(const Choice& choice, std::ostream* stream) { *stream << choice.label; }

class EverySolver : public testing::TestWithParam<Choice> {
 protected:
  std::unique_ptr<LinearSolver> solver_ = fresh();
  static std::unique_ptr<LinearSolver> fresh() {
    Options options;
    options.solver = GetParam().solver;
    options.ordering = GetParam().ordering;
    options.tolerance = GetParam().tolerance;
    return make_solver(options);
  }
  /// The error of a direct solver, or what an iterative one leaves.
  static double within(double rounding) { return std::max(rounding, GetParam().residual); }
};

INSTANTIATE_TEST_SUITE_P(
    Solvers, EverySolver,
    testing::Values(Choice{SolverKind::supernodal, OrderingKind::metis, "supernodal_metis"},
                    Choice{SolverKind::supernodal, OrderingKind::amd, "supernodal_amd"},
                    Choice{SolverKind::cholmod, OrderingKind::metis, "cholmod_metis"},
                    Choice{SolverKind::cholmod, OrderingKind::amd, "cholmod_amd"},
                    Choice{SolverKind::tacho, OrderingKind::metis, "tacho_metis"},
                    Choice{SolverKind::tacho, OrderingKind::amd, "tacho_amd"},
                    Choice{SolverKind::klu2, OrderingKind::amd, "klu2_amd"},
#ifdef PFV_WITH_MUMPS
                    Choice{SolverKind::mumps, OrderingKind::automatic, "mumps"},
#endif
                    Choice{SolverKind::amg, OrderingKind::automatic, "amg", 1e-10, 1e-12},
                    Choice{SolverKind::cg, OrderingKind::automatic, "cg", 1e-10},
                    Choice{SolverKind::gauss_seidel, OrderingKind::automatic, "gauss_seidel",
                           1e-10}),
    [](const auto& info) { return std::string(info.param.label); });

// The discrete parabola i (n + 1 - i) / 2 is the exact solution for a right-hand side of ones.
TEST_P(EverySolver, GivesTheParabolaOfALine) {
  const int n = 10;
  const Eigen::VectorXd x = solution(*solver_, compressed(line(n)), Eigen::VectorXd::Ones(n));
  for (int i = 1; i <= n; ++i) EXPECT_NEAR(x[i - 1], 0.5 * i * (n + 1 - i), 50 * within(2e-15));
}

TEST_P(EverySolver, TakesNoUnknowns) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
  solver_->order(SymmetricMatrix{});
  solver_->factor(SymmetricMatrix{});
  solver_->solve(Eigen::VectorXd(), x);
  EXPECT_EQ(x.size(), 0);
}

TEST_P(EverySolver, TakesOneUnknown) {
  const Eigen::VectorXd b = Eigen::VectorXd::Constant(1, 6.0);
  EXPECT_NEAR(solution(*solver_, compressed(Rows{{{0, 4.0}}}), b)[0], 1.5, 1.5 * within(3e-16));
}

TEST_P(EverySolver, TakesADiagonalMatrixOverThirtyDecades) {
  Rows rows(31);
  for (int i = 0; i < 31; ++i) rows[i][i] = std::pow(10.0, i - 20);
  const Eigen::VectorXd x = solution(*solver_, compressed(rows), Eigen::VectorXd::Ones(31));
  for (int i = 0; i < 31; ++i) EXPECT_NEAR(x[i] * rows[i][i], 1.0, within(1e-15) * 6);
}

TEST_P(EverySolver, TakesGroupsThatDoNotTouch) {
  Rows rows = line(7);
  rows[3] = {{3, 5.0}};
  rows[2].erase(3);
  rows[4].erase(3);
  const SymmetricMatrix matrix = compressed(rows);
  const Eigen::VectorXd b = right_side(7);
  const Eigen::VectorXd x = solution(*solver_, matrix, b);
  EXPECT_NEAR(x[3], b[3] / 5.0, within(1e-16) * 5);
  EXPECT_LE(residual(matrix, x, b), within(1e-15));
}

TEST_P(EverySolver, LeavesNoResidualOnAThousandPores) {
  const SymmetricMatrix matrix = lattice(10);
  const Eigen::VectorXd b = right_side(matrix.size());
  EXPECT_LE(residual(matrix, solution(*solver_, matrix, b), b), within(1e-12));
}

TEST_P(EverySolver, LeavesNoResidualOnFiveThousandPores) {
  const SymmetricMatrix matrix = lattice(17);
  const Eigen::VectorXd b = right_side(matrix.size());
  EXPECT_LE(residual(matrix, solution(*solver_, matrix, b), b), within(1e-12));
}

// One block of columns, from narrower than any unit of the solver's loops to several of them.
TEST_P(EverySolver, TakesFullMatricesOfEachSize) {
  for (int n = 1; n <= 40; ++n) {
    Rows rows(n);
    for (int i = 0; i < n; ++i) {
      rows[i][i] += 1.0;
      for (int j = 0; j < i; ++j) connect(rows, i, j, 1.0 / (1.0 + i + 2.0 * j));
    }
    const SymmetricMatrix matrix = compressed(rows);
    const Eigen::VectorXd b = right_side(n);
    EXPECT_LE(residual(matrix, solution(*solver_, matrix, b), b), within(1e-14)) << n;
  }
}

TEST_P(EverySolver, KeepsItsFactorForFurtherRightHandSides) {
  const SymmetricMatrix matrix = lattice(8);
  const Eigen::VectorXd b = right_side(matrix.size());
  const Eigen::VectorXd first = solution(*solver_, matrix, b);
  Eigen::VectorXd second;
  solver_->solve(2.0 * b, second);
  EXPECT_EQ(second, 2.0 * first);
}

TEST_P(EverySolver, DoesNotChangeTheRightHandSide) {
  const SymmetricMatrix matrix = lattice(5);
  Eigen::VectorXd b = right_side(matrix.size());
  solution(*solver_, matrix, b);
  EXPECT_EQ(b, right_side(matrix.size()));
}

TEST_P(EverySolver, FactorsOtherValuesOnTheSamePattern) {
  const SymmetricMatrix other = lattice(8, 1.0, 2);
  const Eigen::VectorXd b = right_side(other.size());
  solution(*solver_, lattice(8, 1.0, 1), b);
  Eigen::VectorXd x;
  solver_->factor(other);
  solver_->solve(b, x);
  EXPECT_EQ(x, solution(*fresh(), other, b));
}

TEST_P(EverySolver, TakesAnotherPatternAfterAFurtherOrder) {
  solution(*solver_, lattice(8), right_side(512));
  const Eigen::VectorXd b = right_side(343);
  EXPECT_EQ(solution(*solver_, lattice(7), b), solution(*fresh(), lattice(7), b));
}

TEST_P(EverySolver, RepeatsEveryBitInANewSolver) {
  const SymmetricMatrix matrix = lattice(12);
  const Eigen::VectorXd b = right_side(matrix.size());
  EXPECT_EQ(solution(*solver_, matrix, b), solution(*fresh(), matrix, b));
}

TEST_P(EverySolver, RepeatsEveryBitInTheNextSolve) {
  const SymmetricMatrix matrix = lattice(12);
  const Eigen::VectorXd b = right_side(matrix.size());
  const Eigen::VectorXd first = solution(*solver_, matrix, b);
  Eigen::VectorXd second;
  solver_->solve(b, second);
  EXPECT_EQ(first, second);
}

TEST_P(EverySolver, RefusesAnExactlySingularMatrix) {
  const SymmetricMatrix matrix =
      compressed(Rows{{{0, 1.0}, {1, -1.0}}, {{0, -1.0}, {1, 1.0}}});
  EXPECT_THROW(solution(*solver_, matrix, right_side(2)), SolverError);
}

TEST_P(EverySolver, AgreesWithSupernodalOnThePoresOfAPacking) {
  const SymmetricMatrix& matrix = packing_system().matrix;
  const Eigen::VectorXd b = right_side(matrix.size());
  const Eigen::VectorXd reference =
      solution(*make_solver(SolverKind::supernodal, OrderingKind::metis), matrix, b);
  const Eigen::VectorXd x = solution(*solver_, matrix, b);
  EXPECT_LT((x - reference).norm(), 1e-9 * reference.norm());
}

TEST_P(EverySolver, NamesTheEntryThatIsNotFinite) {
  SymmetricMatrix matrix = compressed(line(5));
  solver_->order(matrix);
  matrix.value[matrix.row_begin[3]] = std::numeric_limits<double>::quiet_NaN();
  const std::string message = message_of<SolverError>([&] { solver_->factor(matrix); });
  EXPECT_TRUE(contains(message, "row 3, column 2")) << message;
}

TEST_P(EverySolver, RefusesToReturnASolutionThatIsNotFinite) {
  const SymmetricMatrix matrix = compressed(line(5));
  const Eigen::VectorXd b =
      Eigen::VectorXd::Constant(5, std::numeric_limits<double>::infinity());
  EXPECT_THROW(solution(*solver_, matrix, b), SolverError);
}

TEST_P(EverySolver, SaysWhenAnEarlierPhaseIsMissing) {
  const SymmetricMatrix matrix = compressed(line(5));
  Eigen::VectorXd x;
  EXPECT_THROW(solver_->factor(matrix), SolverError);
  solver_->order(matrix);
  EXPECT_THROW(solver_->solve(Eigen::VectorXd::Ones(5), x), SolverError);
}

TEST_P(EverySolver, RefusesAMatrixOfAnotherSizeThanTheOrdered) {
  solver_->order(compressed(line(5)));
  EXPECT_THROW(solver_->factor(compressed(line(6))), SolverError);
}

TEST_P(EverySolver, RefusesAMatrixOfAnotherPatternThanTheOrdered) {
  solver_->order(compressed(line(5)));
  Rows rewired = line(5);
  rewired[0].erase(1);
  rewired[1].erase(0);
  rewired[0][4] = rewired[4][0] = -1.0;  // as many entries as before
  EXPECT_THROW(solver_->factor(compressed(rewired)), SolverError);
}

TEST_P(EverySolver, RefusesARightHandSideOfAnotherLength) {
  const SymmetricMatrix matrix = compressed(line(5));
  EXPECT_THROW(solution(*solver_, matrix, Eigen::VectorXd::Ones(4)), SolverError);
}

TEST_P(EverySolver, GoesOnAfterAFailedFactor) {
  const SymmetricMatrix good = compressed(line(5));
  SymmetricMatrix bad = good;
  std::fill(bad.value.begin(), bad.value.end(), 0.0);
  solver_->order(good);
  EXPECT_THROW(solver_->factor(bad), SolverError);
  solver_->factor(good);
  Eigen::VectorXd x;
  solver_->solve(Eigen::VectorXd::Ones(5), x);
  EXPECT_NEAR(x[2], 4.5, within(1e-14) * 10);
}

TEST_P(EverySolver, FailsSilentlyAndInOneLine) {
  const SymmetricMatrix matrix = compressed(Rows{{{0, 0.0}}, {{1, 0.0}}});
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  solver_->order(matrix);
  const std::string message = message_of<SolverError>([&] { solver_->factor(matrix); });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(contains(message, solver_->name())) << message;
  EXPECT_FALSE(contains(message, "\n")) << message;
}
}  // namespace pfv

}  // namespace
}  // namespace linear_solver_test
