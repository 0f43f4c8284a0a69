// SPDX-License-Identifier: GPL-3.0-or-later
// What a Flow does again at a step and what it keeps, read from its counts.
#include "step/built_network.hpp"
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/drained_piston.hpp"
#include "support/packings.hpp"
#include "support/motions.hpp"
#include "support/stages.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace flow_reuse_test {
namespace {

using namespace support;

constexpr double dt = 2.5e-4;

/// The grains sink with v = (0, 0, -z).
struct Piston : DrainedPiston {
  Piston() { sink(1.0); }
  /// max |dV/dt| / V over the pores, 1/s (thesis eqs. 5.13-5.14).
  double strain_rate() const {
    const Stages s = stages_of(packing, box);
    const Eigen::VectorXd rates = reciprocal_rates(s, motion_of(packing.velocities, box));
    double largest = 0.0;
    for (int p = 0; p < s.network.pores(); ++p) {
      const double volume = s.throats.pore_fluid_volume[p];
      EXPECT_GT(volume, 4.0 / 3.0 * pi * std::pow(0.1, 3) * 0.01) << "the bound is not at work";
      largest = std::max(largest, std::abs(rates[p]) / volume);
    }
    return largest;
  }
};

/// The packing with each grain put elsewhere by a part of its radius.
pfv::PackingArrays put_elsewhere(pfv::PackingArrays packing, double part) {
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k)
    packing.positions.col(k) += part * packing.radii[k] * Eigen::Vector3d(k % 2 ? 0.6 : -0.6, k % 3 ? 0.8 : -0.8, 0.0);
  return packing;
}

// One flow that is shown one packing after the other gave the first one's permeability, five times too little.
TEST(FlowReuse, ALookIsAtTheGrainsAsTheyAre) {
  auto packing = random_packing(40, 0.05, 0.1, 1);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  for (const double part : {0.02, 0.1, 0.1, 0.5}) {
    packing = put_elsewhere(packing, part);
    pfv::Flow fresh(upward_box(pfv::Wall::no_slip), viscosity_one());
    EXPECT_TRUE(flow.evaluate(packing.view()).total == fresh.evaluate(packing.view()).total) << part;
  }
  EXPECT_EQ(flow.retriangulations(), 4);
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.retriangulations(), 4);
}

TEST(FlowReuse, AStepAfterALookAtOthersIsAtItsOwnGrains) {
  const auto packing = random_packing(40, 0.05, 0.1, 1), other = put_elsewhere(packing, 0.3);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  const Eigen::Matrix3Xd before = flow.step(packing.view(), dt).total;
  flow.evaluate(other.view());
  EXPECT_TRUE(flow.step(packing.view(), dt).total == before);
  EXPECT_FALSE(flow.step(other.view(), dt).total == before);  // nothing says that they have moved there
  EXPECT_EQ(flow.retriangulations(), 3);
}

// As in a host that looks at the grains at the end of each step; the strain alone asks for a network.
TEST(FlowReuse, GrainsThatMoveWithTheirVelocitiesKeepTheNetworkInLooksToo) {
  Piston piston;
  pfv::Flow flow(piston.box, viscosity_one());
  for (int i = 0; i < 3; ++i) {
    flow.step(piston.packing.view(), dt);
    piston.packing.positions += dt * piston.packing.velocities;
    flow.evaluate(piston.packing.view());
  }
  EXPECT_EQ(flow.retriangulations(), 0);
}

TEST(FlowReuse, StillGrainsCostOneNetworkOneFactorAndASolveAStep) {
  const auto packing = random_packing(40, 0.05, 0.1, 1);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  for (int i = 0; i < 5; ++i) flow.step(packing.view(), dt);
  const pfv::Counts counts = flow.report().counts;
  EXPECT_EQ(counts.triangulate, 1);
  EXPECT_EQ(counts.order, 1);
  EXPECT_EQ(counts.factor, 1);
  EXPECT_EQ(counts.solve, 5);
  EXPECT_EQ(counts.force_matrix, 1);
  EXPECT_EQ(counts.volume_rate, 0);
  EXPECT_EQ(flow.strain(), 0.0);
  EXPECT_NEAR(flow.time(), 5 * dt, 1e-15);
}

TEST(FlowReuse, VelocitiesOfZeroAreGrainsAtRest) {
  auto packing = random_packing(40, 0.05, 0.1, 1);
  packing.velocities = Eigen::Matrix3Xd::Zero(3, 40);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.step(packing.view(), dt);
  EXPECT_EQ(flow.report().counts.volume_rate, 0);
  EXPECT_TRUE(flow.report().permeability.has_value());
}

TEST(FlowReuse, NoForceMatrixWhereForcesAreNotAskedFor) {
  const auto packing = random_packing(40, 0.05, 0.1, 1);
  pfv::Options options;
  options.forces = false;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), options);
  EXPECT_EQ(flow.step(packing.view(), dt).total.cols(), 0);
  EXPECT_EQ(flow.report().counts.force_matrix, 0);
  EXPECT_TRUE(flow.report().permeability.has_value());
}

TEST(FlowReuse, MovingGrainsCostOneVolumeRateAStepAndNoNewFactor) {
  const Piston piston;
  pfv::Options options;
  options.retriangulation_strain = 1e9;
  pfv::Flow flow(piston.box, viscosity_one(), options);
  for (int i = 0; i < 4; ++i) flow.step(piston.packing.view(), dt);
  const pfv::Counts counts = flow.report().counts;
  EXPECT_EQ(counts.volume_rate, 4);
  EXPECT_EQ(counts.triangulate, 1);
  EXPECT_EQ(counts.factor, 1);
  EXPECT_EQ(counts.force_matrix, 1);
}

TEST(FlowReuse, StrainIsTheLargestRelativeVolumeRateTimesTheStep) {
  const Piston piston;
  const double rate = piston.strain_rate();
  pfv::Options options;
  options.strain_measure = pfv::StrainMeasure::largest;
  pfv::Flow flow(piston.box, viscosity_one(), options);
  flow.step(piston.packing.view(), dt);
  EXPECT_NEAR(flow.strain() / (rate * dt), 1.0, 1e-12);
  flow.step(piston.packing.view(), 2.0 * dt);
  EXPECT_NEAR(flow.strain() / (3.0 * rate * dt), 1.0, 1e-12);
}

TEST(FlowReuse, TriangulatesAnewAtTheStepAfterTheStrainReachesTheThreshold) {
  const Piston piston;
  const double each = piston.strain_rate() * dt;
  pfv::Options options;
  options.strain_measure = pfv::StrainMeasure::largest;
  options.retriangulation_strain = 2.5 * each;  // reached by the third step
  pfv::Flow flow(piston.box, viscosity_one(), options);
  for (int i = 0; i < 3; ++i) flow.step(piston.packing.view(), dt);
  EXPECT_EQ(flow.report().counts.triangulate, 1);
  EXPECT_GE(flow.strain(), options.retriangulation_strain);
  flow.step(piston.packing.view(), dt);
  EXPECT_EQ(flow.report().counts.triangulate, 2);
  EXPECT_EQ(flow.retriangulations(), 1);
  EXPECT_NEAR(flow.strain() / each, 1.0, 1e-12);
}

TEST(FlowReuse, ThresholdOfOnePercentIsTheDefault) {
  EXPECT_EQ(pfv::Options{}.retriangulation_strain, 0.01);
}

/// Triangulations after one step with each of two packings.
int triangulations(const pfv::PackingArrays& first, const pfv::PackingArrays& second) {
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), options);
  flow.step(first.view(), dt);
  flow.step(second.view(), dt);
  EXPECT_EQ(flow.forces().total.cols(), second.positions.cols());
  return static_cast<int>(flow.report().counts.triangulate);
}

TEST(FlowReuse, AnInsertedOrDeletedGrainLeadsToANewNetwork) {
  const auto few = random_packing(30, 0.05, 0.08, 5);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 29; ++k)
    spheres.push_back({few.positions(0, k), few.positions(1, k), few.positions(2, k),
                       few.radii[k]});
  const auto fewer = packing_of(spheres);
  EXPECT_EQ(triangulations(few, fewer), 2);
  EXPECT_EQ(triangulations(fewer, few), 2);
}

TEST(FlowReuse, AnotherGrainInThePlaceOfOneLeadsToANewNetwork) {
  const auto before = random_packing(30, 0.05, 0.08, 5);
  auto after = before;
  after.ids[7] = 99;
  EXPECT_EQ(triangulations(before, after), 2);
}

TEST(FlowReuse, AGrainThatLeavesTheBoxOrReturnsLeadsToANewNetwork) {
  const auto before = random_packing(30, 0.05, 0.08, 5);
  auto after = before;
  after.positions(0, 3) = 1.02;
  EXPECT_EQ(triangulations(before, after), 2);
  EXPECT_EQ(triangulations(after, before), 2);
}

TEST(FlowReuse, ARadiusThatGrowsByAThirdOfTheStrainLeadsToANewNetwork) {
  const auto before = random_packing(30, 0.05, 0.08, 5);
  auto after = before;
  after.radii[4] *= 1.0 + 0.0034;  // threshold 0.01 / 3
  EXPECT_EQ(triangulations(before, after), 2);
  after.radii[4] = before.radii[4] * (1.0 + 0.0033);
  EXPECT_EQ(triangulations(before, after), 1);
}

TEST(FlowReuse, AJumpByMoreThanARadiusOrBeyondTheVelocityLeadsToANewNetwork) {
  const auto before = random_packing(30, 0.05, 0.08, 5);
  auto after = before;
  int k = 0;  // a grain with room to the right
  while (before.positions(0, k) > 0.8) ++k;
  const auto jump_by = [&](double radii, double of_it_by_velocity) {
    const double way = radii * before.radii[k];
    after.positions(0, k) = before.positions(0, k) + way;
    after.velocities = Eigen::Matrix3Xd::Zero(3, 30);
    after.velocities(0, k) = of_it_by_velocity * way / dt;
    return triangulations(before, after);
  };
  EXPECT_EQ(jump_by(1.01, 1.0), 2);
  EXPECT_EQ(jump_by(0.99, 1.0), 1);
  EXPECT_EQ(jump_by(0.0101, 0.0), 2);  // threshold 0.01
  EXPECT_EQ(jump_by(0.0099, 0.0), 1);
}

TEST(FlowReuse, GrainsOutsideGetNoForceAndAreCounted) {
  auto packing = random_packing(30, 0.05, 0.08, 5);
  packing.positions(0, 3) = 1.02;
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), options);
  const pfv::Forces& forces = flow.step(packing.view(), dt);
  EXPECT_TRUE(forces.total.col(3).isZero(0.0));
  EXPECT_FALSE(forces.total.col(2).isZero(0.0));
  EXPECT_EQ(flow.hidden_or_outside(), 1);
  EXPECT_EQ(flow.report().outside, 1);
}

TEST(FlowReuse, OtherBoundaryValuesKeepNetworkAndFactor) {
  const Piston piston;
  pfv::Options options;
  options.retriangulation_strain = 1e9;
  pfv::Flow flow(piston.box, viscosity_one(), options);
  flow.step(piston.packing.view(), dt);
  pfv::Box box = piston.box;
  box[pfv::Face::zhi].boundary.value = 7.0;
  box[pfv::Face::zhi].velocity = -2.0;
  box.upper[2] = 0.999;
  flow.set_box(box);
  flow.step(piston.packing.view(), dt);
  const pfv::Counts counts = flow.report().counts;
  EXPECT_EQ(counts.triangulate, 1);
  EXPECT_EQ(counts.factor, 1);
  EXPECT_NEAR(flow.report().volume_rate_sum, -2.0, 1e-12);
}

TEST(FlowReuse, AnotherKindOfBoundaryWallOrPatchLeadsToANewNetwork) {
  const auto packing = random_packing(30, 0.05, 0.08, 5);
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  pfv::Patch patch;
  patch.rectangle = {0.4, 0.6, 0.4, 0.6};
  patch.boundary = pfv::Boundary::pressure(0.0);
  std::vector<pfv::Box> others(4, box);
  others[0][pfv::Face::zlo].boundary = pfv::Boundary::flux(1.0);
  others[1][pfv::Face::xlo].wall = pfv::Wall::symmetry;
  others[2].patches.push_back(patch);
  others[3][pfv::Face::xhi].boundary = pfv::Boundary::pressure(0.0);
  for (const pfv::Box& other : others) {
    pfv::Flow flow(box, viscosity_one());
    flow.step(packing.view(), dt);
    flow.set_box(other);
    flow.step(packing.view(), dt);
    EXPECT_EQ(flow.report().counts.triangulate, 2);
  }
}

TEST(FlowReuse, EvaluateAdvancesNothing) {
  const Piston piston;
  pfv::Fluid fluid = viscosity_one();
  fluid.bulk_modulus = 1e3;
  pfv::Flow flow(piston.box, fluid), other(piston.box, fluid);
  flow.step(piston.packing.view(), dt);
  other.step(piston.packing.view(), dt);
  const pfv::FlowState before = flow.state();
  flow.evaluate(piston.packing.view(), dt);
  flow.evaluate(piston.packing.view(), dt);
  EXPECT_EQ(flow.time(), before.time);
  EXPECT_EQ(flow.strain(), before.strain);
  EXPECT_EQ(flow.state().pore_pressures, before.pore_pressures);
  EXPECT_TRUE(flow.step(piston.packing.view(), dt).total ==
              other.step(piston.packing.view(), dt).total);
}

TEST(FlowReuse, ResultsAreTheSameBytesEveryTime) {
  const Piston piston;
  const auto run = [&] {
    pfv::PackingArrays packing = piston.packing;
    pfv::Options options;
    options.strain_measure = pfv::StrainMeasure::largest;
    options.retriangulation_strain = 3.0 * dt * piston.strain_rate();
    pfv::Flow flow(piston.box, viscosity_one(), options);
    std::vector<double> bytes;
    for (int i = 0; i < 10; ++i) {
      const pfv::Forces& forces = flow.step(packing.view(), dt);
      bytes.insert(bytes.end(), forces.total.data(), forces.total.data() + forces.total.size());
      packing.positions += dt * packing.velocities;
    }
    EXPECT_GT(flow.retriangulations(), 0);
    return bytes;
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

TEST(FlowReuse, AKeptNetworkGivesTheBytesOfAFreshOne) {
  const Piston piston;
  pfv::Flow kept(piston.box, viscosity_one()), fresh(piston.box, viscosity_one());
  kept.evaluate(piston.packing.view());
  kept.evaluate(piston.packing.view());
  fresh.evaluate(piston.packing.view());
  EXPECT_TRUE(kept.forces().total == fresh.forces().total);
  EXPECT_TRUE(kept.pore_pressures() == fresh.pore_pressures());
}

/// 60 grains in the unit cube; the face xhi is moved between two calls.
struct MovedFace {
  pfv::PackingArrays packing = random_packing(60, 0.05, 0.1, 4);
  pfv::Box box = upward_box(pfv::Wall::symmetry);
  pfv::Flow flow{box, viscosity_one()};

  MovedFace() { flow.evaluate(packing.view()); }
  void move_to(double place) {
    box.upper[0] = place;
    flow.set_box(box);
  }
};

TEST(FlowReuse, OtherExtentsLeadToANewNetwork) {
  for (const double place : {2.0, 1.01, 0.999}) {
    MovedFace moved;
    moved.move_to(place);
    moved.flow.evaluate(moved.packing.view());
    pfv::Flow fresh(moved.box, viscosity_one());
    const pfv::Forces& forces = fresh.evaluate(moved.packing.view());
    EXPECT_EQ(moved.flow.report().counts.triangulate, 2);
    EXPECT_EQ(*moved.flow.report().permeability, *fresh.report().permeability) << place;
    EXPECT_EQ(moved.flow.forces().total, forces.total);
  }
}

TEST(FlowReuse, AFaceThatJumpsBeforeAStepLeadsToANewNetwork) {
  MovedFace moved;
  moved.move_to(1.2);
  moved.flow.step(moved.packing.view(), dt);
  EXPECT_EQ(moved.flow.retriangulations(), 1);
}

TEST(FlowReuse, AFaceThatMovesWithItsVelocityKeepsTheNetwork) {
  MovedFace moved;
  moved.flow.set_retriangulation(pfv::StrainMeasure::mean, 0.5);
  moved.box[pfv::Face::xhi].velocity = 1.0;
  for (int step = 1; step <= 20; ++step) {
    moved.move_to(1.0 + step * dt);
    moved.flow.step(moved.packing.view(), dt);
  }
  EXPECT_EQ(moved.flow.retriangulations(), 0);
  moved.box[pfv::Face::xhi].velocity = 0.0;  // it stops: moved by the velocity of the step before
  moved.move_to(1.0 + 21 * dt);
  moved.flow.step(moved.packing.view(), dt);
  EXPECT_EQ(moved.flow.retriangulations(), 0);
}

}  // namespace
}  // namespace flow_reuse_test
