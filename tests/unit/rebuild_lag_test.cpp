// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that are built in the background: when they are taken up, and that nothing depends on
// when the thread is done.
#include "work/phase_clock.hpp"
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "support/long_steps.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace rebuild_lag_test {
namespace {

using namespace pfv;

constexpr double dt = 1e-3;
constexpr int lag = 3;
constexpr double never = std::numeric_limits<double>::infinity();

/// Grains that sink with v = -0.25 z under a drained piston, each also its own way: about every
/// sixth step reaches the strain.
struct Column {
  Box box;
  PackingArrays packing = dense_packing(200);
  int steps = 0;

  Column() {
    box[Face::zhi].boundary = Boundary::pressure(0.0);
    box[Face::zhi].velocity = -0.25;
    packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
    packing.velocities.row(2) = -0.25 * packing.positions.row(2);
    for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
      packing.velocities(0, k) += 0.02 * std::sin(static_cast<double>(k));
  }
  void advance() {
    ++steps;
    packing.positions += dt * packing.velocities;
    box.upper[2] += dt * box[Face::zhi].velocity;
  }
};

Options lagging(int steps = lag) {
  Options options;
  options.rebuild_lag = steps;
  options.strain_measure = StrainMeasure::largest;
  options.sphere_pressure = true;
  return options;
}

Options kept() {
  Options options = lagging(0);
  options.retriangulation_strain = never;
  return options;
}

using Step = std::function<const Forces&(Flow&, const PackingArrays&)>;

const Forces& explicit_step(Flow& flow, const PackingArrays& packing) {
  return flow.step(packing.view(), dt);
}

const Forces& staged_step(Flow& flow, const PackingArrays& packing) {
  static const Eigen::VectorXd masses = Eigen::VectorXd::Constant(packing.ids.size(), 1e-5);
  static const Eigen::Matrix3Xd others = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
  GrainDynamics grains;
  new (&grains.masses) Eigen::Map<const Eigen::VectorXd>(masses.data(), masses.size());
  new (&grains.other_forces) Eigen::Map<const Eigen::Matrix3Xd>(others.data(), 3, others.cols());
  return support::step_staged(flow, packing.view(), dt, grains);
}

/// The forces of each step of a sinking column.
std::vector<Eigen::Matrix3Xd> forces_of_run(Flow& flow, int steps, const Step& step) {
  Column column;
  std::vector<Eigen::Matrix3Xd> forces;
  while (column.steps < steps) {
    flow.set_box(column.box);
    forces.push_back(step(flow, column.packing).total);
    column.advance();
  }
  return forces;
}

/// What a lag means, spelt out with networks that are built where they stand: that of the step at
/// which the strain is reached serves from `lag` steps later on, when only the strain since counts.
void expect_lagging_networks(const Step& step, StrainMeasure measure = StrainMeasure::largest) {
  Options with_lag = lagging(), without = kept();
  with_lag.strain_measure = without.strain_measure = measure;
  if (measure == StrainMeasure::mean) with_lag.retriangulation_strain = 2e-3;
  Flow lagged(Column().box, Fluid{}, with_lag);
  auto used = std::make_unique<Flow>(Column().box, Fluid{}, without);
  std::unique_ptr<Flow> next;
  int waiting = 0, taken = 0;
  double strain = 0.0, begun = 0.0;
  for (Column column; column.steps < 40; column.advance()) {
    if (next && ++waiting == lag) {
      used = std::move(next);
      strain -= begun;
      ++taken;
    }
    if (!next && strain >= lagged.options().retriangulation_strain) {
      next = std::make_unique<Flow>(column.box, Fluid{}, without);
      next->evaluate(column.packing.view());
      begun = strain;
      waiting = 0;
    }
    lagged.set_box(column.box);
    used->set_box(column.box);
    const Forces& forces = step(lagged, column.packing);
    strain -= used->strain();
    ASSERT_TRUE(forces.total == step(*used, column.packing).total) << column.steps;
    strain += used->strain();
    ASSERT_TRUE(forces.sphere_pressure == used->forces().sphere_pressure) << column.steps;
    ASSERT_TRUE(lagged.pore_pressures() == used->pore_pressures()) << column.steps;
    ASSERT_EQ(lagged.retriangulations(), taken) << column.steps;
    ASSERT_NEAR(lagged.strain(), strain, 1e-12) << column.steps;
  }
  EXPECT_GE(taken, 3);
  EXPECT_EQ(lagged.report().counts.background, taken);
  EXPECT_LT(lagged.report().mass_error, 1e-9);
}

TEST(RebuildLag, TakesUpTheNetworkOfTheStepThatReachedTheStrain) {
  expect_lagging_networks(explicit_step);
}

TEST(RebuildLag, StagedStepsToo) {
  expect_lagging_networks(staged_step);
  Flow flow(Column().box, Fluid{}, lagging());
  staged_step(flow, Column().packing);
  EXPECT_GT(flow.stages(), 1);
}

// The volumes of this column change at constant rates, so that mean strains add up too.
TEST(RebuildLag, MeanStrainsToo) { expect_lagging_networks(explicit_step, StrainMeasure::mean); }

TEST(RebuildLag, GivesTheSameBytesInEveryRun) {
  Fluid compressible;
  compressible.bulk_modulus = 1e3;
  for (const SolverKind solver : {SolverKind::supernodal, SolverKind::amg})
    for (const Fluid& fluid : {Fluid{}, compressible})
      for (const Step& step : {Step(explicit_step), Step(staged_step)}) {
        std::vector<Eigen::Matrix3Xd> first;
        for (const int threads : {1, 2}) {
          Options options = lagging();
          options.solver = solver;
          options.threads = solver == SolverKind::amg ? 1 : threads;
          Flow flow(Column().box, fluid, options);
          const auto forces = forces_of_run(flow, 30, step);
          EXPECT_GE(flow.report().counts.background, 2);
          EXPECT_LT(flow.report().mass_error, solver == SolverKind::amg ? 1e-6 : 1e-9);
          if (first.empty()) first = forces;
          EXPECT_TRUE(forces == first);
        }
      }
}

TEST(RebuildLag, AmgFindsWhatAFactorDoes) {
  Options exact = lagging(), iterated = lagging();
  iterated.solver = SolverKind::amg;
  iterated.tolerance = 1e-11;
  Flow one(Column().box, Fluid{}, exact), other(Column().box, Fluid{}, iterated);
  const auto expected = forces_of_run(one, 30, explicit_step), found = forces_of_run(other, 30, explicit_step);
  for (std::size_t step = 0; step < expected.size(); ++step)
    EXPECT_LT((found[step] - expected[step]).norm(), 1e-9 * expected[step].norm()) << "step " << step;
  EXPECT_GE(other.report().counts.background, 2);
  EXPECT_EQ(other.report().counts.background, one.report().counts.background);
}

TEST(RebuildLag, KeepsTheFluidThatACompressibleOneStores) {
  Fluid fluid;
  fluid.bulk_modulus = 1e3;
  Flow flow(Column().box, fluid, lagging());
  const auto stored = [&] { return flow.mean_pressure() * flow.pore_volumes().sum(); };
  Column column;
  double before = 0.0;
  for (; flow.retriangulations() == 0; column.advance()) {
    before = flow.time() > 0.0 ? stored() : 0.0;
    flow.set_box(column.box);
    flow.step(column.packing.view(), dt);
  }
  // what the step itself has stored is the rest
  EXPECT_NEAR((stored() - before) / (*fluid.bulk_modulus * dt), flow.report().storage_rate,
              0.02 * std::abs(flow.report().storage_rate));
}

TEST(RebuildLag, EvaluateNeitherBeginsNorTakesUp) {
  Flow flow(Column().box, Fluid{}, lagging()), other(Column().box, Fluid{}, lagging());
  for (Column column; column.steps < 30; column.advance()) {
    for (Flow* one : {&flow, &other}) one->set_box(column.box);
    for (int i = 0; i < 4; ++i) flow.evaluate(column.packing.view());
    EXPECT_TRUE(flow.step(column.packing.view(), dt).total ==
                other.step(column.packing.view(), dt).total);
  }
  EXPECT_GE(other.retriangulations(), 2);
}

/// Runs to the step after the first network was begun; then `change` and one step, which needs a
/// network of its own.
void expect_dropped(const std::function<void(Flow&, Column&)>& change) {
  Options options = lagging(), here = kept();
  options.outside = here.outside = OutsideGrains::leave_out;
  Flow flow(Column().box, Fluid{}, options);
  Column column;
  const auto step = [&] {
    flow.set_box(column.box);
    flow.step(column.packing.view(), dt);
  };
  for (; flow.strain() < 0.01; column.advance()) step();
  step();  // begins
  column.advance();
  change(flow, column);
  step();
  EXPECT_EQ(flow.retriangulations(), 1);
  Flow fresh(column.box, Fluid{}, here);
  EXPECT_TRUE(flow.forces().total == fresh.step(column.packing.view(), dt).total);
  for (int i = 0; i < lag; ++i) {  // and nothing is taken up later
    column.advance();
    if (flow.strain() < 0.01) step();
  }
  EXPECT_EQ(flow.retriangulations(), 1);
  EXPECT_EQ(flow.report().counts.background, 0);
}

TEST(RebuildLag, WhatNeedsANetworkAtOnceDropsTheOtherOne) {
  expect_dropped([](Flow& flow, Column&) { flow.rebuild(); });
  expect_dropped([](Flow&, Column& column) { column.packing.ids[7] = 9999; });
  expect_dropped([](Flow&, Column& column) { column.packing.positions(0, 3) = 1.02; });
  expect_dropped([](Flow&, Column& column) { column.packing.radii[5] *= 1.004; });
  expect_dropped([](Flow&, Column& column) { column.box[Face::xlo].wall = Wall::symmetry; });
}

TEST(RebuildLag, FailsAtTheStepThatTakesUp) {
  // a flux that finds no pore is seen when a network is built
  Column column;
  column.box[Face::xlo].boundary = Boundary::flux(0.0);
  column.box.patches.push_back({Face::xlo, {-1.0, 2.0, -1.0, 2.0}, Boundary::pressure(0.0)});
  Flow flow(column.box, Fluid{}, lagging());
  const auto step = [&] {
    flow.set_box(column.box);
    flow.step(column.packing.view(), dt);
  };
  for (; flow.strain() < 0.01; column.advance()) step();
  column.box[Face::xlo].boundary.value = 1e-9;
  for (int i = 0; i < lag; ++i, column.advance()) step();
  try {
    step();
    ADD_FAILURE() << "taken up";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its flux has no pore to enter"), std::string::npos);
  }
  EXPECT_THROW(flow.forces(), InputError);
  column.box[Face::xlo].boundary.value = 0.0;
  step();
  EXPECT_EQ(flow.report().counts.background, 0);
}

TEST(RebuildLag, EndsWithTheFlow) {
  Column column;
  auto flow = std::make_unique<Flow>(column.box, Fluid{}, lagging(1000));
  for (; flow->strain() < 0.01; column.advance()) explicit_step(*flow, column.packing);
  explicit_step(*flow, column.packing);
  flow.reset();  // waits for the thread
}

TEST(RebuildLag, RefusesWhatCannotRunBesideASteppingThread) {
  const auto refusal = [](const std::function<void(Options&)>& change) {
    Options options = lagging();
    change(options);
    try {
      check(options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal([](Options&) {}), "");
  const auto expect = [&](const char* part, const std::function<void(Options&)>& change) {
    EXPECT_NE(refusal(change).find(part), std::string::npos) << refusal(change);
  };
  expect("rebuild lag is -1", [](Options& o) { o.rebuild_lag = -1; });
  expect("klu2 does not factor", [](Options& o) { o.solver = SolverKind::klu2; });
  expect("ordering metis", [](Options& o) { o.ordering = OrderingKind::metis; });
  EXPECT_EQ(refusal([](Options& o) { o.solver = SolverKind::cg; }), "");

  const Column column;
  Flow flow(column.box, Fluid{}, lagging());
  EXPECT_THROW(support::step_implicit(flow, column.packing.view(), dt, {}), InputError);
}

// The BLAS below CHOLMOD need not bear two threads.
TEST(RebuildLag, NetworksOfTwoFlowsAtOnceAreThoseOfOne) {
  Column column;
  Flow alone(column.box, Fluid{}, kept());
  const Eigen::Matrix3Xd expected = alone.step(column.packing.view(), dt).total;
  const auto differing = [&] {
    int count = 0;
    for (int i = 0; i < 10; ++i) {
      Flow flow(column.box, Fluid{}, kept());
      if (flow.step(column.packing.view(), dt).total != expected) ++count;
    }
    return count;
  };
  auto other = std::async(std::launch::async, differing);
  EXPECT_EQ(differing(), 0);
  EXPECT_EQ(other.get(), 0);
}

TEST(PhaseClock, LeavesOutWhatRunsInTheBackground) {
  double of_background = 0.0;
  const double before = cpu_seconds();
  std::thread([&] {
    const BackgroundWork work;
    const double start = cpu_seconds();
    while ((of_background = cpu_seconds() - start) < 0.05) {}
  }).join();
  EXPECT_GE(of_background, 0.05);
  EXPECT_LT(cpu_seconds() - before, 0.5 * of_background);
}

}  // namespace
}  // namespace rebuild_lag_test
