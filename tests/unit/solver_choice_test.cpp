// SPDX-License-Identifier: GPL-3.0-or-later
// Which solver and ordering a choice stands for.
#include "solve/linear_solver.hpp"

#include "pfv/error.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>

namespace pfv {
namespace {

using namespace support;

TEST(Multiply, GivesTheProductOfAKnownMatrix) {
  const Eigen::VectorXd x = Eigen::Vector3d(1.0, 2.0, 4.0);
  EXPECT_EQ(multiply(compressed(line(3)), x), Eigen::Vector3d(0.0, -1.0, 6.0));
}

TEST(Multiply, OfNoUnknownsIsEmpty) {
  EXPECT_EQ(multiply(SymmetricMatrix{}, Eigen::VectorXd()).size(), 0);
}

TEST(SolverChoice, AutomaticIsCholmodInGeometricOrder) {
  EXPECT_EQ(resolved(SolverKind::automatic), SolverKind::cholmod);
  EXPECT_EQ(resolved(SolverKind::automatic, OrderingKind::automatic), OrderingKind::geometric);
}

TEST(SolverChoice, AutomaticOrderingOfKlu2IsAmd) {
  EXPECT_EQ(resolved(SolverKind::klu2, OrderingKind::automatic), OrderingKind::amd);
}

TEST(SolverChoice, AnExplicitOrderingIsKept) {
  EXPECT_EQ(resolved(SolverKind::cholmod, OrderingKind::amd), OrderingKind::amd);
}

TEST(SolverChoice, Klu2WithMetisIsRefusedAndAmdNamed) {
  const std::string message = message_of<InputError>(
      [] { make_solver(SolverKind::klu2, OrderingKind::metis); });
  EXPECT_TRUE(contains(message, "klu2")) << message;
  EXPECT_TRUE(contains(message, "amd")) << message;
}

TEST(SolverChoice, ASolverHasTheNameThatTheUserChose) {
  EXPECT_EQ(make_solver(SolverKind::automatic, OrderingKind::automatic)->name(), "cholmod");
  EXPECT_EQ(make_solver(SolverKind::klu2, OrderingKind::automatic)->name(), "klu2");
}

#ifndef PFV_WITH_MUMPS
TEST(Mumps, IsRefusedByABuildWithoutIt) {
  const std::string message = message_of<InputError>(
      [] { make_solver(SolverKind::mumps, OrderingKind::automatic); });
  EXPECT_TRUE(contains(message, "PFV_WITH_MUMPS")) << message;
}
#endif

}  // namespace
}  // namespace pfv
