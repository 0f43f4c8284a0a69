// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "solve/linear_solver.hpp"
#include "problem/solver_abilities.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace pfv {
namespace direct_solvers_test {
namespace {

using namespace support;

constexpr SolverKind with_pivots[] = {SolverKind::supernodal, SolverKind::cholmod};

TEST(DirectSolvers, NameTheRowThatIsNotPositive) {
  Rows rows = line(6);
  rows[4][4] = -2.0;
  const SymmetricMatrix matrix = compressed(rows);
  for (const SolverKind kind : with_pivots) {
    const auto solver = make_solver(kind, OrderingKind::amd);
    solver->order(matrix);
    const std::string message = message_of<SolverError>([&] { solver->factor(matrix); });
    EXPECT_TRUE(contains(message, "not positive definite at row 4")) << message;
    EXPECT_EQ(message.rfind(name_of(kind), 0), 0u) << message;
  }
}

std::vector<SolverKind> direct_solvers() {
  std::vector<SolverKind> found;
  for (const SolverKind kind : {SolverKind::supernodal, SolverKind::cholmod, SolverKind::tacho,
                                SolverKind::klu2, SolverKind::mumps})
    if (is_built(kind)) found.push_back(kind);
  return found;
}

// Rounding leaves a last pivot of either sign; both signs must be refused.
TEST(DirectSolvers, RefuseLatticesWithoutAnyImposedPressure) {
  for (const SolverKind kind : direct_solvers())
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const SymmetricMatrix matrix = lattice(9, 0.0, seed);
      const auto solver = make_solver(kind, OrderingKind::automatic);
      solver->order(matrix);
      const std::string message = message_of<SolverError>([&] { solver->factor(matrix); });
      EXPECT_EQ(message.rfind(name_of(kind), 0), 0u) << message << ", seed " << seed;
    }
}

// One group of pores out of two hangs on nothing.
TEST(DirectSolvers, RefuseAGroupWithoutAnyImposedPressure) {
  Rows rows(40);
  for (int i = 0; i < 39; ++i)
    if (i != 19) connect(rows, i, i + 1, 1.0 + 0.37 * i);
  rows[0][0] += 1.0;
  const SymmetricMatrix matrix = compressed(rows);
  for (const SolverKind kind : direct_solvers()) {
    const auto solver = make_solver(kind, OrderingKind::automatic);
    solver->order(matrix);
    EXPECT_THROW(solver->factor(matrix), SolverError) << name_of(kind);
  }
}

// Tied to the imposed pressure by 1e-8 of its other conductances: ill conditioned, and solvable.
TEST(DirectSolvers, SolveABadlyConditionedLatticeToTheSamePressures) {
  const SymmetricMatrix matrix = lattice(12, 1e-8);
  const Eigen::VectorXd p = 2.0 + right_side(matrix.size()).array();
  const Eigen::VectorXd b = multiply(matrix, p);
  for (const SolverKind kind : direct_solvers()) {
    const Eigen::VectorXd x = solution(*make_solver(kind, OrderingKind::automatic), matrix, b);
    EXPECT_LT(residual(matrix, x, b), 1e-11) << name_of(kind);
    EXPECT_LT((x - p).norm(), 1e-5 * p.norm()) << name_of(kind);
  }
}

TEST(Supernodal, StartsNoThread) {
  const auto threads = [] {
    const std::filesystem::directory_iterator first("/proc/self/task");
    return std::distance(begin(first), end(first));
  };
  const SymmetricMatrix matrix = lattice(24);
  const auto before = threads();
  solution(*make_solver(SolverKind::supernodal, OrderingKind::metis), matrix,
           right_side(matrix.size()));
  EXPECT_EQ(threads(), before);
}

TEST(DirectSolvers, AgreeWithKlu2InEachOrdering) {
  const SymmetricMatrix matrix = lattice(15);
  const Eigen::VectorXd b = right_side(matrix.size());
  const Eigen::VectorXd reference =
      solution(*make_solver(SolverKind::klu2, OrderingKind::automatic), matrix, b);
  for (const SolverKind kind : {SolverKind::supernodal, SolverKind::cholmod, SolverKind::tacho})
    for (const OrderingKind ordering : {OrderingKind::metis, OrderingKind::amd}) {
      const Eigen::VectorXd x = solution(*make_solver(kind, ordering), matrix, b);
      EXPECT_LT((x - reference).norm(), 1e-10 * reference.norm()) << name_of(kind);
    }
}
}  // namespace pfv

}  // namespace
}  // namespace direct_solvers_test
