// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "solve/linear_solver.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <filesystem>
#include <iterator>

namespace pfv {
namespace {

using namespace support;

TEST(Cholmod, NamesTheRowThatIsNotPositive) {
  Rows rows = line(6);
  rows[4][4] = -2.0;
  const SymmetricMatrix matrix = compressed(rows);
  const auto solver = make_solver(SolverKind::cholmod, OrderingKind::amd);
  solver->order(matrix);
  const std::string message = message_of<SolverError>([&] { solver->factor(matrix); });
  EXPECT_TRUE(contains(message, "not positive definite at row 4")) << message;
}

// Rounding leaves a last pivot of either sign; both signs must be refused.
TEST(Cholmod, RefusesLatticesWithoutAnyImposedPressure) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const SymmetricMatrix matrix = lattice(9, 0.0, seed);
    const auto solver = make_solver(SolverKind::cholmod, OrderingKind::metis);
    solver->order(matrix);
    EXPECT_THROW(solver->factor(matrix), SolverError) << "seed " << seed;
  }
}

TEST(Cholmod, StartsNoThread) {
  const auto threads = [] {
    const std::filesystem::directory_iterator first("/proc/self/task");
    return std::distance(begin(first), end(first));
  };
  const SymmetricMatrix matrix = lattice(24);
  const auto before = threads();
  solution(*make_solver(SolverKind::cholmod, OrderingKind::metis), matrix,
           right_side(matrix.size()));
  EXPECT_EQ(threads(), before);
}

TEST(Cholmod, AgreesWithKlu2) {
  const SymmetricMatrix matrix = lattice(15);
  const Eigen::VectorXd b = right_side(matrix.size());
  const Eigen::VectorXd reference =
      solution(*make_solver(SolverKind::klu2, OrderingKind::automatic), matrix, b);
  for (const OrderingKind ordering : {OrderingKind::metis, OrderingKind::amd}) {
    const Eigen::VectorXd x = solution(*make_solver(SolverKind::cholmod, ordering), matrix, b);
    EXPECT_LT((x - reference).norm(), 1e-10 * reference.norm());
  }
}

}  // namespace
}  // namespace pfv
