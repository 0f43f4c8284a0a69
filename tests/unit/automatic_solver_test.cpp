// SPDX-License-Identifier: GPL-3.0-or-later
// `solver auto`: a factor where it pays, amg where a network serves few solves.
#include "step/automatic_solver.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/flow.hpp"

#include <gtest/gtest.h>

namespace {

using pfv::SolverKind;

pfv::Options open_from(std::int64_t spheres) {
  pfv::Options options;
  options.amg_from = spheres;
  return options;
}

pfv::Box seepage() {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  return box;
}

}  // namespace

TEST(AutomaticSolver, TakesAFactorForSmallPackings) {
  pfv::AutomaticSolver automatic({}, false);
  ASSERT_TRUE(automatic.is_open());
  automatic.begin(49999, {});
  EXPECT_EQ(automatic.now({}), SolverKind::supernodal);
  EXPECT_EQ(automatic.reason(SolverKind::supernodal), "");
}

TEST(AutomaticSolver, TakesAmgFor2000SpheresAndMoreBehindANetworkThatServedFewSolves) {
  for (const Eigen::Index spheres : {1999, 2000, 20000}) {
    pfv::AutomaticSolver automatic({}, false);
    pfv::Counts counts;
    automatic.begin(spheres, counts);
    EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
    counts.solve = 2;
    automatic.begin(spheres, counts);
    EXPECT_EQ(automatic.now(counts), spheres < 2000 ? SolverKind::supernodal : SolverKind::amg);
    counts.solve = 102;  // a factor would have paid by now
    EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
    automatic.begin(spheres, counts);
    EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
  }
}

TEST(AutomaticSolver, OnceStepsAreTakenTheyAloneCount) {
  pfv::AutomaticSolver automatic({}, false);
  pfv::Counts counts, before;
  automatic.begin(20000, counts);
  counts.solve = 30;
  automatic.count_step(before, counts, false);
  counts.solve = 500;  // of setups
  counts.limit_solve = 100;
  automatic.begin(20000, counts);
  EXPECT_EQ(automatic.last_served(), 30.0);
  EXPECT_EQ(automatic.now(counts), SolverKind::amg);
  before = counts;
  counts.solve += 1;
  automatic.count_step(before, counts, true);  // with the limit that its network needs
  EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
  automatic.begin(20000, counts);
  EXPECT_EQ(automatic.last_served(), 101.0);
}

TEST(AutomaticSolver, OneThatGoesOnChoosesAsTheOneBefore) {
  for (const double served : {3.0, 300.0, pfv::AutomaticSolver::unknown}) {
    pfv::AutomaticSolver automatic({}, false);
    automatic.restore(served);
    EXPECT_EQ(automatic.last_served(), served);
    automatic.begin(20000, {});
    EXPECT_EQ(automatic.last_served(), served);
    EXPECT_EQ(automatic.now({}), served == 3.0 ? SolverKind::amg : SolverKind::supernodal);
  }
}

/// 2500 spheres whose grains change places with each step.
TEST(AutomaticSolver, AFlowTakesAmgOnNetworksOfOneStepAndHandsItOn) {
  pfv::PackingArrays packing = pfv::dense_packing(2500);
  packing.velocities = Eigen::Matrix3Xd::Random(3, 2500) * 1e-3;
  pfv::Options exact;
  exact.solver = SolverKind::supernodal;
  pfv::Flow flow(seepage(), {}), other(seepage(), {}), direct(seepage(), {}, exact);
  const auto step = [&](pfv::Flow& one) {
    one.rebuild();
    return Eigen::Matrix3Xd(one.step(packing.view(), 1e-3).total);
  };
  step(flow);
  EXPECT_EQ(flow.report().solver, "supernodal");
  const Eigen::Matrix3Xd found = step(flow), expected = step(direct);
  EXPECT_EQ(flow.report().solver, "amg");
  EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);
  other.set_state(flow.state());
  EXPECT_EQ(step(other), step(flow));
  EXPECT_EQ(other.report().solver, "amg");
}

TEST(AutomaticSolver, BeginsLargeOnesWithAmgAndChangesOverOnceAFactorWouldHavePaid) {
  pfv::AutomaticSolver automatic({}, false);
  pfv::Counts counts;
  automatic.begin(100000, counts);
  EXPECT_EQ(automatic.now(counts), SolverKind::amg);
  EXPECT_NE(automatic.reason(SolverKind::amg).find("100000 spheres"), std::string::npos);
  counts.solve = 237;
  EXPECT_EQ(automatic.now(counts), SolverKind::amg);
  counts.solve = 239;
  EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
  counts = {};
  counts.limit_solve = 60;  // each sets out from nothing
  EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
}

TEST(AutomaticSolver, GoesByWhatTheNetworkBeforeHasServed) {
  pfv::AutomaticSolver automatic({}, false);
  pfv::Counts counts;
  automatic.begin(100000, counts);
  counts.solve = 500;
  automatic.begin(100000, counts);
  EXPECT_EQ(automatic.now(counts), SolverKind::supernodal);
  counts.solve = 510;
  automatic.begin(100000, counts);
  EXPECT_EQ(automatic.now(counts), SolverKind::amg);
}

TEST(AutomaticSolver, LeavesAloneWhatWasAskedFor) {
  pfv::Options options;
  options.solver = SolverKind::supernodal;
  EXPECT_FALSE(pfv::AutomaticSolver(options, false).is_open());
  options = {};
  options.threads = 2;
  EXPECT_FALSE(pfv::AutomaticSolver(options, false).is_open());
  options = {};
  options.ordering = pfv::OrderingKind::metis;
  EXPECT_FALSE(pfv::AutomaticSolver(options, false).is_open());
  EXPECT_FALSE(pfv::AutomaticSolver({}, true).is_open());
}

TEST(AutomaticSolver, AFactorThatDoesNotFitIsNotTried) {
  pfv::AutomaticSolver automatic({}, false);
  pfv::Counts counts;
  automatic.begin(500'000'000, counts);
  counts.solve = 1'000'000'000;
  EXPECT_EQ(automatic.now(counts), SolverKind::amg);
  EXPECT_NE(automatic.reason(SolverKind::amg).find("does not fit in memory"), std::string::npos);
}

/// 300 spheres pay from the second solve on.
TEST(AutomaticSolver, AFlowChangesOverOnItsNetwork) {
  const pfv::PackingArrays packing = pfv::dense_packing(300);
  pfv::Flow flow(seepage(), {}, open_from(100)), direct(seepage(), {});
  const Eigen::Matrix3Xd expected = direct.evaluate(packing.view()).total;
  const double largest = expected.colwise().norm().maxCoeff();
  EXPECT_LT((flow.evaluate(packing.view()).total - expected).colwise().norm().maxCoeff(), 1e-5 * largest);
  EXPECT_EQ(flow.report().solver, "amg");
  EXPECT_NE(flow.report().solver_made_of.find("pays from"), std::string::npos);
  for (int step = 0; step < 3; ++step) flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().solver, "supernodal");
  EXPECT_EQ(flow.report().counts.triangulate, 1);
  EXPECT_EQ(flow.report().counts.factor, 2);
  EXPECT_LT((flow.forces().total - expected).colwise().norm().maxCoeff(), 1e-12 * largest);
  flow.rebuild();
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().solver, "supernodal");  // the network before has served more than one solve
}

TEST(AutomaticSolver, WhereAmgComesToNoSolutionAFactorIsTriedUntilTheNextNetwork) {
  pfv::AutomaticSolver automatic(open_from(pfv::amg_from_for_one_solution), false);
  automatic.begin(20000, {});
  EXPECT_EQ(automatic.now({}), SolverKind::amg);
  EXPECT_TRUE(automatic.takes_factor_after_failure());
  EXPECT_EQ(automatic.now({}), SolverKind::supernodal);
  automatic.begin(20000, {});
  EXPECT_EQ(automatic.now({}), SolverKind::amg);
  automatic.begin(500'000'000, {});
  EXPECT_FALSE(automatic.takes_factor_after_failure());  // does not fit
  EXPECT_EQ(automatic.now({}), SolverKind::amg);
}

TEST(AutomaticSolver, AnImplicitStepHasAFactor) {
  pfv::PackingArrays packing = pfv::dense_packing(200);
  packing.velocities = Eigen::Matrix3Xd::Constant(3, 200, 1e-4);
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(200);
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, 200);
  const pfv::GrainDynamics dynamics{{masses.data(), 200}, {none.data(), 3, 200}};
  pfv::Flow flow(seepage(), {}, open_from(100)), direct(seepage(), {});
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().solver, "amg");
  direct.evaluate(packing.view());
  const pfv::Step step = pfv::Step::with(pfv::Coupling::implicit, dynamics);
  const Eigen::Matrix3Xd expected = direct.advance(packing.view(), 1e-3, step).total;
  const Eigen::Matrix3Xd& found = flow.advance(packing.view(), 1e-3, step).total;
  EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm());
}
