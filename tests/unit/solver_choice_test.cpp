// SPDX-License-Identifier: GPL-3.0-or-later
// Which solver and ordering a choice stands for.
#include "solve/linear_solver.hpp"
#include "problem/solver_abilities.hpp"

#include "pfv/error.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <functional>
#include <string>

namespace pfv {
namespace solver_choice_test {
namespace {

using namespace support;

TEST(Multiply, GivesTheProductOfAKnownMatrix) {
  const Eigen::VectorXd x = Eigen::Vector3d(1.0, 2.0, 4.0);
  EXPECT_EQ(multiply(compressed(line(3)), x), Eigen::Vector3d(0.0, -1.0, 6.0));
}

TEST(Multiply, OfNoUnknownsIsEmpty) {
  EXPECT_EQ(multiply(SymmetricMatrix{}, Eigen::VectorXd()).size(), 0);
}

TEST(SolverChoice, AutomaticIsSupernodalInGeometricOrder) {
  EXPECT_EQ(resolved(SolverKind::automatic), SolverKind::supernodal);
  EXPECT_EQ(resolved(SolverKind::automatic, OrderingKind::automatic), OrderingKind::geometric);
}

TEST(SolverChoice, AutomaticOrderingOfKlu2IsAmd) {
  EXPECT_EQ(resolved(SolverKind::klu2, OrderingKind::automatic), OrderingKind::amd);
}

TEST(SolverChoice, AutomaticOrderingOfTachoIsMetis) {
  EXPECT_EQ(resolved(SolverKind::tacho, OrderingKind::automatic), OrderingKind::metis);
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
  EXPECT_EQ(make_solver(SolverKind::automatic, OrderingKind::automatic)->name(), "supernodal");
  EXPECT_EQ(make_solver(SolverKind::klu2, OrderingKind::automatic)->name(), "klu2");
}

/// What the options are refused with, or nothing.
std::string refusal(const std::function<void(Options&)>& change) {
  Options options;
  change(options);
  try {
    check(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(SolverChoice, WhatASolverCannotDoIsRefusedAndThoseThatCanAreNamed) {
  for (const SolverKind kind : {SolverKind::cholmod, SolverKind::tacho, SolverKind::klu2}) {
    const std::string lag = refusal([&](Options& o) { o.solver = kind, o.rebuild_lag = 3; });
    EXPECT_EQ(lag.rfind("the solver " + std::string(name_of(kind)), 0), 0u) << lag;
    EXPECT_TRUE(contains(lag, "supernodal, amg, cg or gauss_seidel")) << lag;
    const std::string mixed =
        refusal([&](Options& o) { o.solver = kind, o.precision = Precision::mixed; });
    EXPECT_TRUE(contains(mixed, "use the solver supernodal")) << mixed;
    const std::string tolerance = refusal([&](Options& o) { o.solver = kind, o.tolerance = 1e-6; });
    EXPECT_TRUE(contains(tolerance, "amg, cg or gauss_seidel")) << tolerance;
  }
  const std::string ordering = refusal([](Options& o) {
    o.solver = SolverKind::cg, o.ordering = OrderingKind::metis;
  });
  EXPECT_TRUE(contains(ordering, "supernodal, cholmod or tacho")) << ordering;
  EXPECT_EQ(refusal([](Options& o) { o.precision = Precision::mixed, o.rebuild_lag = 3; }), "");
}

TEST(SolverChoice, ItIsSaidWhichCodeOrderedFactoredAndSolved) {
  EXPECT_EQ(made_of(SolverKind::automatic, OrderingKind::automatic),
            "ordered by pfv (geometric), analysed by CHOLMOD, factored by pfv, solved by pfv; called "
            "through Amesos2");
  EXPECT_EQ(made_of(SolverKind::cholmod, OrderingKind::metis),
            "ordered by METIS (metis), analysed by CHOLMOD, factored by CHOLMOD, solved by CHOLMOD; "
            "called through Amesos2");
  EXPECT_EQ(made_of(SolverKind::tacho, OrderingKind::automatic),
            "ordered by METIS (metis), analysed by Tacho, factored by Tacho, solved by Tacho; called "
            "through Amesos2");
  EXPECT_EQ(made_of(SolverKind::amg, OrderingKind::automatic),
            "preconditioned by hypre's BoomerAMG, solved by pfv");
  EXPECT_EQ(made_of(SolverKind::cg, OrderingKind::automatic), "preconditioned by pfv, solved by pfv");
}

#ifndef PFV_WITH_MUMPS
TEST(Mumps, IsRefusedByABuildWithoutIt) {
  const std::string message = message_of<InputError>(
      [] { make_solver(SolverKind::mumps, OrderingKind::automatic); });
  EXPECT_TRUE(contains(message, "PFV_WITH_MUMPS")) << message;
}
#endif
}  // namespace pfv

}  // namespace
}  // namespace solver_choice_test
