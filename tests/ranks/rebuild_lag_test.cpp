// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that a second thread of each rank builds while the ranks solve for their steps.
#include "as_on_one_rank.hpp"
#include "world.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/flow.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace {

constexpr double dt = 1e-3;

/// Grains that sink under a drained piston, each also its own way: about every sixth step reaches the strain.
struct Column {
  pfv::Box box;
  pfv::PackingArrays packing = pfv::dense_packing(100);
  std::vector<int> columns;

  Column() {
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
    box[pfv::Face::zhi].velocity = -0.25;
    packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
    packing.velocities.row(2) = -0.25 * packing.positions.row(2);
    for (Eigen::Index k = 0; k < packing.ids.size(); ++k) packing.velocities(0, k) += 0.02 * std::sin(static_cast<double>(k));
    columns = own_columns(packing, Deal::by_place);
  }
  pfv::PackingArrays part() const { return part_of(packing, columns); }
  void advance() {
    packing.positions += dt * packing.velocities;
    box.upper[2] += dt * box[pfv::Face::zhi].velocity;
  }
};

pfv::Options lagging() {
  pfv::Options options = tight();
  options.rebuild_lag = 3;
  options.strain_measure = pfv::StrainMeasure::largest;
  return options;
}

const pfv::Forces& step(pfv::Flow& flow, const Column& column, const pfv::PackingArrays& packing, double length = dt) {
  flow.set_box(column.box);
  return flow.step(packing.view(), length);
}

void expect_as_on_one_rank(const pfv::Fluid& fluid, const std::vector<double>& lengths) {
  Column column;
  pfv::Flow one(column.box, fluid, lagging()), all(column.box, fluid, lagging(), world());
  for (int k = 0; k < 16; ++k, column.advance()) {
    const double length = lengths[static_cast<std::size_t>(k) % lengths.size()];
    const pfv::Forces& expected = step(one, column, column.packing, length);
    const pfv::Forces& found = step(all, column, column.part(), length);
    ASSERT_LT(difference_of(found.total, expected.total, column.columns).rms, 1e-9) << "step " << k;
    ASSERT_EQ(all.retriangulations(), one.retriangulations()) << "step " << k;
    ASSERT_NEAR(all.strain() / one.strain(), 1.0, 1e-9) << "step " << k;
  }
  EXPECT_GE(one.report().counts.background, 2);
  EXPECT_EQ(all.report().counts.background, one.report().counts.background);
  EXPECT_LT(all.report().mass_error, 1e-8);
}

TEST(RebuildLagOnRanks, NetworksAreThoseOfOneRankStepForStep) { expect_as_on_one_rank({}, {dt}); }

// Another time step is another matrix: its hierarchy waits for that of the network that is on its way.
TEST(RebuildLagOnRanks, ACompressibleFluidWhoseTimeStepChanges) {
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  expect_as_on_one_rank(fluid, {dt, dt, 0.5 * dt});
}

TEST(RebuildLagOnRanks, GivesTheSameBytesInEveryRun) {
  std::vector<Eigen::Matrix3Xd> first;
  for (int run = 0; run < 2; ++run) {
    Column column;
    pfv::Flow flow(column.box, {}, lagging(), world());
    for (int k = 0; k < 12; ++k, column.advance()) {
      const Eigen::Matrix3Xd forces = step(flow, column, column.part()).total;
      if (run == 0) first.push_back(forces);
      ASSERT_TRUE(forces == first[static_cast<std::size_t>(k)]) << "run " << run << ", step " << k;
    }
    EXPECT_GE(flow.report().counts.background, 1);
  }
}

TEST(RebuildLagOnRanks, WhatFailsInTheBackgroundAllTellAtTheStepThatTakesItUp) {
  Column column;  // a flux that finds no pore is seen when a network is built
  column.box[pfv::Face::xlo].boundary = pfv::Boundary::flux(0.0);
  column.box.patches.push_back({pfv::Face::xlo, {-1.0, 2.0, -1.0, 2.0}, pfv::Boundary::pressure(0.0)});
  pfv::Flow flow(column.box, {}, lagging(), world());
  for (; flow.strain() < 0.01; column.advance()) step(flow, column, column.part());
  column.box[pfv::Face::xlo].boundary.value = 1e-9;
  for (int k = 0; k < 3; ++k, column.advance()) step(flow, column, column.part());
  try {
    step(flow, column, column.part());
    ADD_FAILURE() << "taken up";
  } catch (const pfv::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its flux has no pore to enter"), std::string::npos) << error.what();
    EXPECT_TRUE(pfv::failed_together(*world()));
  }
  column.box[pfv::Face::xlo].boundary.value = 0.0;
  step(flow, column, column.part());
  EXPECT_EQ(flow.report().counts.background, 0);
}

TEST(RebuildLagOnRanks, ANetworkOnItsWayEndsWithTheFlow) {
  Column column;
  pfv::Options options = lagging();
  options.rebuild_lag = 1000;
  pfv::Flow flow(column.box, {}, options, world());
  for (; flow.strain() < 0.01; column.advance()) step(flow, column, column.part());
  step(flow, column, column.part());
  flow.rebuild();  // drops it, and another begins below
  step(flow, column, column.part());
  for (; flow.strain() < 0.01; column.advance()) step(flow, column, column.part());
  step(flow, column, column.part());
  EXPECT_EQ(flow.report().counts.background, 0);
}

}  // namespace
