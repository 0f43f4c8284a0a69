// SPDX-License-Identifier: GPL-3.0-or-later
// What several ranks find together is what one rank finds.
#include "as_on_one_rank.hpp"

#include "pfv/flow.hpp"
#include "pfv/error.hpp"
#include "pfv/solve_plan.hpp"
#include "support/containers.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <gtest/gtest.h>
#include <string>

namespace {

pfv::Box seepage() {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(2.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(-1.0);
  return box;
}

pfv::PackingArrays moving(pfv::PackingArrays packing) {
  set_in_motion(packing, 4);
  return packing;
}

}  // namespace

TEST(SharedFlow, SeepageThroughABedAtRest) {
  expect_as_on_one_rank({dense_bed(in_long(400, 150)), seepage(), {}, tight(), 0.0, every_deal});
}

TEST(SharedFlow, GrainsThatMoveAndFacesThatDo) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  box[pfv::Face::xlo].velocity = 0.3;
  box[pfv::Face::zhi].velocity = -0.2;
  expect_as_on_one_rank({moving(dense_bed(in_long(400, 150))), box});
}

TEST(SharedFlow, FluxesAndPatchesAndAWell) {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  box[pfv::Face::xhi].boundary = pfv::Boundary::flux(-3e-4);
  box.patches.push_back({pfv::Face::zhi, {0.3, 0.7, 0.2, 0.6}, pfv::Boundary::pressure(0.5)});
  box.patches.push_back({pfv::Face::ylo, {0.5, 0.5001, 0.5, 0.5001}, pfv::Boundary::pressure(0.1)});
  box.regions.push_back({{0.4, 0.4, 0.4}, {0.4001, 0.4001, 0.4001}, pfv::Boundary::flux(2e-4)});
  expect_as_on_one_rank({moving(dense_bed(in_long(400, 150))), box});
}

/// Two pores are as near to the place of the patch as each other.
TEST(SharedFlow, APatchBetweenPoresOfALattice) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  box.patches.push_back({pfv::Face::zlo, {0.374, 0.376, 0.374, 0.376}, pfv::Boundary::pressure(1.0)});
  const pfv::PackingArrays lattice = support::lattice(support::Lattice::sc, 4, 0.95);
  const pfv::PackingArrays part = part_of(lattice, own_columns(lattice, Deal::by_place));
  pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
  one.evaluate(lattice.view());
  all.evaluate(part.view());
  EXPECT_EQ(all.report().openings[0].pores, 1);
  EXPECT_NEAR(all.report().inflow / one.report().inflow, 1.0, 1e-9);  // by symmetry, whichever it is
}

TEST(SharedFlow, RegionsOfManyPoresThatTouchImposedPressures) {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(0.0);
  box.regions.push_back({{0.0, 0.0, 1e-5}, {1.0, 1.0, 0.6}, pfv::Boundary::flux(1.0)});
  expect_as_on_one_rank({dense_bed(in_long(300, 120)), box});
}

TEST(SharedFlow, ARegionThatTakesAllPoresHasNoWayOut) {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(0.0);
  box[pfv::Face::zlo].boundary = pfv::Boundary::sealed();
  box.patches.push_back({pfv::Face::zhi, {0.5, 0.5001, 0.5, 0.5001}, pfv::Boundary::pressure(0.0)});
  box.regions.push_back({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, pfv::Boundary::flux(1.0)});
  const pfv::PackingArrays packing = dense_bed(100);
  const pfv::PackingArrays part = part_of(packing, own_columns(packing, Deal::by_place));
  pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
  EXPECT_THROW(one.evaluate(packing.view()), pfv::InputError);
  EXPECT_THROW(all.evaluate(part.view()), pfv::InputError);
}

TEST(SharedFlow, NeighboursThatSlidePastEachOther) {
  pfv::Options options = tight();
  options.shear_viscous = options.split_forces = true;
  expect_as_on_one_rank({moving(dense_bed(in_long(400, 150))), seepage(), {}, options, 0.0, every_deal});
  expect_as_on_one_rank({moving(support::random_packing(60, 0.02, 0.04, 3)), seepage(), {}, options});
}

TEST(SharedFlow, GrainsInOnePlane) {
  pfv::PackingArrays packing = support::random_packing(60, 0.02, 0.03, 8);
  packing.positions.row(2).setConstant(0.5);
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) packing.positions(0, k) = (0.5 + static_cast<double>(k)) / 60.0;
  expect_as_on_one_rank({packing, seepage()});
}

TEST(SharedFlow, ACompressibleFluidBetweenSealedWalls) {
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  pfv::Box box;
  box[pfv::Face::zhi].velocity = -1e-3;
  expect_as_on_one_rank({moving(dense_bed(in_long(300, 120))), box, fluid, tight(), 1e-3});
}

TEST(SharedFlow, GrainsThatSettleInOpenWater) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Fluid fluid;
  fluid.gravity = {0.0, 0.0, -9.81};
  for (const int grains : {1, 3, 60}) expect_as_on_one_rank({moving(support::random_packing(grains, 0.02, 0.04, 3)), box, fluid});
}

/// Pressures are carried from network to network, grains are dealt anew, and a state goes from ranks to one and back.
TEST(SharedFlow, ACompressibleFluidOnNewNetworks) {
  const double dt = 1e-3;
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(2.0);
  box[pfv::Face::zlo].velocity = 0.1;
  pfv::PackingArrays packing = moving(dense_bed(in_long(200, 80)));
  packing.velocities *= 0.3;
  pfv::Flow one(box, fluid, tight()), all(box, fluid, tight(), world());
  const auto compare = [&](pfv::Flow& some, pfv::Flow& alone, Deal deal, const char* when) {
    const std::vector<int> columns = own_columns(packing, deal);
    const pfv::Forces& expected = alone.step(packing.view(), dt);
    const pfv::Forces& found = some.step(part_of(packing, columns).view(), dt);
    EXPECT_LT(difference_of(found.total, expected.total, columns).rms, 1e-9) << when;
    EXPECT_NEAR(some.mean_pressure() / alone.mean_pressure(), 1.0, 1e-9) << when;
    EXPECT_NEAR(*some.report().fluid_balance_error, *alone.report().fluid_balance_error, 1e-9) << when;
  };
  for (int step = 0; step < 12; ++step) {
    if (step == 4 || step == 8) {  // to deal grains anew makes a network more
      one.rebuild();
      all.rebuild();
    }
    compare(all, one, step < 4 ? Deal::by_place : step < 8 ? Deal::at_random : Deal::all_to_one, "on the way");
    packing.positions += dt * packing.velocities;
    box.lower[2] += dt * 0.1;
    one.set_box(box);
    all.set_box(box);
  }
  EXPECT_GE(one.retriangulations(), 4);
  one.rebuild();
  all.rebuild();
  const std::vector<int> columns = own_columns(packing, Deal::by_place);
  one.evaluate(packing.view(), dt);
  all.evaluate(part_of(packing, columns).view(), dt);
  const pfv::FlowState of_one = one.state(), of_all = all.state();
  ASSERT_EQ(of_all.pore_pressures.size(), world()->own() == 0 ? of_one.pore_pressures.size() : 0);
  double apart = 0.0, largest = 0.0;
  for (std::size_t p = 0; p < of_all.pore_pressures.size(); ++p) {
    apart = std::max(apart, std::abs(of_all.pore_pressures[p] - of_one.pore_pressures[p]));
    largest = std::max(largest, std::abs(of_one.pore_pressures[p]));
  }
  EXPECT_LE(apart, 1e-8 * largest);
  pfv::Flow crossed(box, fluid, tight()), shared(box, fluid, tight(), world());
  shared.set_state(of_one);
  crossed.set_state(of_one);
  compare(shared, crossed, Deal::at_random, "from the state of one rank");
  pfv::Flow again(box, fluid, tight(), world()), before(box, fluid, tight());
  again.set_state(of_all);
  before.set_state(of_one);
  compare(again, before, Deal::by_place, "from the state of ranks");
  pfv::FlowState wrong = of_one;
  wrong.pore_pressures.pop_back();
  pfv::Flow refused(box, fluid, tight(), world());
  refused.set_state(wrong);
  EXPECT_THROW(refused.step(part_of(packing, columns).view(), dt), pfv::InputError);
}

TEST(SharedFlow, OverlapsThatCutPoresOff) {
  const pfv::PackingArrays lattice = support::lattice(support::Lattice::fcc, 3, 1.17);
  pfv::Flow one(seepage(), {}, tight());
  one.evaluate(lattice.view());
  ASSERT_GT(one.report().counts.pinned_pores, 0);
  expect_as_on_one_rank({lattice, seepage()});
}

TEST(SharedFlow, ContainersOfPlanesAndACylinder) {
  support::Random random(5);
  pfv::Container cylinder = support::cylinder({0.0, 0.0, 1.0}, {0.5, 0.5, 0.0}, 0.4, 1.0);
  pfv::Container prism = support::prism(7, 0.4, 1.0);
  pfv::Options options = tight();
  options.torques = false;
  for (pfv::Container* container : {&cylinder, &prism}) {
    const int last = container->face_count() - 1;
    container->faces[last].boundary = pfv::Boundary::pressure(1.0);
    container->faces[last - 1].boundary = pfv::Boundary::pressure(0.0);
    expect_as_on_one_rank({support::spheres_in(*container, in_long(300, 120), 0.06, random), *container, {}, options});
  }
}

TEST(SharedFlow, StepsWithNewNetworksAsOnOneRank) {
  pfv::PackingArrays packing = moving(dense_bed(in_long(300, 120)));
  packing.velocities *= in_long(0.05, 0.08);
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  const std::vector<int> columns = own_columns(packing, Deal::by_place);
  pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
  const double dt = 2e-3;
  for (int step = 0; step < 12; ++step) {
    const pfv::PackingArrays part = part_of(packing, columns);
    const pfv::Forces& expected = one.step(packing.view(), dt);
    const pfv::Forces& found = all.step(part.view(), dt);
    EXPECT_LT(difference_of(found.total, expected.total, columns).rms, 1e-9) << "step " << step;
    EXPECT_EQ(all.retriangulations(), one.retriangulations());
    EXPECT_NEAR(all.strain(), one.strain(), 1e-12);
    packing.positions += dt * packing.velocities;
  }
  EXPECT_GE(one.retriangulations(), 2);
  EXPECT_NEAR(*all.report().fluid_balance_error, *one.report().fluid_balance_error, 1e-9);
}

/// Far above the limit of explicit steps, with a piston, grains under their weight, one of them held.
TEST(SharedFlow, StagedStepsAsOnOneRank) {
  pfv::PackingArrays packing = moving(dense_bed(in_long(300, 80)));
  packing.velocities *= 0.05;
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.5);
  pfv::Fluid fluid;
  fluid.gravity = {0.0, 0.0, -9.81};
  Loads loads{1e4 * packing.radii.array().cube(), Eigen::Matrix3Xd::Zero(3, packing.ids.size())};
  loads.others.row(2) = -9.81 * loads.masses.transpose();
  loads.masses[17] = std::numeric_limits<double>::infinity();
  loads.pistons[5] = {0.5, -3.0};
  for (const Deal deal : {Deal::by_place, Deal::all_to_one}) {
    pfv::Options options = tight();
    options.shear_viscous = deal == Deal::by_place;
    if (deal == Deal::all_to_one) fluid.bulk_modulus = 1e3;
    const std::vector<int> columns = own_columns(packing, deal);
    const Loads own = loads.of(columns);
    const pfv::GrainDynamics of_all = own.view();
    pfv::Flow one(box, fluid, options), all(box, fluid, options, world());
    one.evaluate(packing.view(), 1e-3);
    const double dt = 30.0 * one.time_step_limit(loads.masses, loads.pistons);
    expect_staged_steps_agree(one, all, {packing, columns, loads.view(), of_all}, dt, 3);
    for (std::size_t f = 0; f < 6; ++f)
      EXPECT_LT((all.face_forces()[f] - one.face_forces()[f]).norm(), 1e-8 * one.face_forces()[4].norm());
    const pfv::PackingArrays part = part_of(packing, columns);
    all.advance(part.view(), dt, {pfv::Coupling::automatic, &of_all, false, 1.0, {}});
    EXPECT_EQ(all.coupling(), pfv::Coupling::staged);
    all.advance(part.view(), 1e-3 * dt, {pfv::Coupling::automatic, &of_all, false, 1.0, {}});
    EXPECT_EQ(all.coupling(), pfv::Coupling::explicit_step);
  }
}

TEST(SharedFlow, TheSameBytesTwice) {
  const pfv::PackingArrays packing = moving(dense_bed(in_long(300, 120)));
  const pfv::PackingArrays part = part_of(packing, own_columns(packing, Deal::by_place));
  const auto forces = [&] {
    pfv::Flow flow(seepage(), {}, tight(), world());
    return Eigen::Matrix3Xd(flow.evaluate(part.view()).total);
  };
  EXPECT_EQ(forces(), forces());
}

TEST(SharedFlow, TheLimitOfTheTimeStep) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  for (const pfv::PackingArrays& packing : {dense_bed(in_long(400, 150)), support::random_packing(40, 0.02, 0.04, 3)}) {
    const Eigen::VectorXd masses = 1e3 * packing.radii.array().cube();
    for (const Deal deal : every_deal) {
      const std::vector<int> columns = own_columns(packing, deal);
      const pfv::PackingArrays part = part_of(packing, columns);
      pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
      one.evaluate(packing.view());
      all.evaluate(part.view());
      std::vector<pfv::Piston> pistons(6);
      pistons[5].mass = 0.02;
      const double expected = one.time_step_limit(masses, pistons);
      const double found = all.time_step_limit(masses(columns), pistons);
      EXPECT_NEAR(found / expected, 1.0, 0.005);  // both are searched for from places of their own
      const pfv::StiffestGrain of_one = one.stiffest_grain(masses), of_all = all.stiffest_grain(masses(columns));
      EXPECT_NEAR(of_all.limit / of_one.limit, 1.0, 1e-9);
      EXPECT_EQ(of_all.id, of_one.id);
      const std::int64_t solves = all.report().counts.limit_solve;
      EXPECT_EQ(all.time_step_limit(masses(columns), pistons), found);
      EXPECT_EQ(all.report().counts.limit_solve, solves);
      Eigen::VectorXd bad = masses(columns);
      if (world()->own() == 0 && bad.size() > 0) bad[0] = -1.0;
      if (world()->any(bad.size() > 0 && bad[0] < 0.0)) {
        EXPECT_THROW(all.time_step_limit(bad, pistons), pfv::InputError);
      }
    }
  }
}

/// A bed that is set in motion by degrees, in the steps of a host: the same intervals, on a rank without grains too.
TEST(SharedFlow, WhenTheFlowIsSolvedNext) {
  pfv::PackingArrays packing = moving(dense_bed(in_long(300, 120)));
  const Eigen::Matrix3Xd velocities = 0.02 * packing.velocities;
  const Eigen::VectorXd masses = 1e3 * packing.radii.array().cube();
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  for (const Deal deal : {Deal::by_place, Deal::all_to_one}) {
    const std::vector<int> columns = own_columns(packing, deal);
    pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
    pfv::SolvePlan of_one(1e-2), of_all(1e-2, world());
    const double dt = 1e-4;
    int longest = 0, passed = 0;
    for (int solve = 0; solve < 15; ++solve) {
      packing.velocities = velocities * (2.0 + std::sin(1e-3 * passed));
      const pfv::PackingArrays part = part_of(packing, columns);
      one.step(packing.view(), dt);
      all.step(part.view(), dt);
      const Eigen::VectorXd own_masses = masses(columns);
      const double motion = packing.velocities.norm();
      const int steps = of_one.next().steps;
      passed += steps;
      of_one.take(one, {packing.view(), masses, {}, steps, dt, motion, 0.0, 0.01});
      of_all.take(all, {part.view(), own_masses, {}, steps, dt, motion, 0.0, 0.01});
      ASSERT_EQ(of_all.next().steps, of_one.next().steps) << "solve " << solve;
      EXPECT_NEAR(of_all.next().sensitivity, of_one.next().sensitivity, 1e-6);
      EXPECT_NEAR(of_all.interval().error(), of_one.interval().error(), 1e-6);
      longest = std::max(longest, of_one.next().steps);
    }
    EXPECT_GE(longest, 3);
  }
}

TEST(SharedFlow, AnErrorOnOneRankIsThatOfAll) {
  const pfv::PackingArrays packing = dense_bed(in_long(200, 160));
  const auto refusal = [&](const pfv::PackingArrays& of) {
    const pfv::PackingArrays part = part_of(of, own_columns(of, Deal::by_place));
    pfv::Flow flow(seepage(), {}, tight(), world());
    try {
      flow.evaluate(part.view());
    } catch (const pfv::InputError& error) {
      EXPECT_TRUE(world()->failed_together());
      return std::string(error.what());
    }
    return std::string();
  };
  pfv::PackingArrays bad = packing;
  bad.radii[17] = -1.0;
  EXPECT_NE(refusal(bad).find("sphere 18"), std::string::npos);
  bad = packing;
  bad.ids[150] = bad.ids[3];
  EXPECT_NE(refusal(bad).find("id 4 occurs twice"), std::string::npos);
  bad = packing;
  bad.positions(0, 9) = 1.5;
  EXPECT_NE(refusal(bad).find("sphere 10"), std::string::npos);
  EXPECT_EQ(refusal(packing), "");
}

TEST(SharedFlow, WhatRanksCannotDoTogetherIsRefused) {
  pfv::Options options = tight();
  options.solver = pfv::SolverKind::supernodal;
  options.tolerance.reset();
  EXPECT_THROW(pfv::Flow(seepage(), {}, options, world()), pfv::InputError);
  options = tight();
  options.volume_rates = pfv::VolumeRates::geometric;
  EXPECT_THROW(pfv::Flow(seepage(), {}, options, world()), pfv::InputError);
  const pfv::PackingArrays packing = dense_bed(100), part = part_of(packing, own_columns(packing, Deal::by_place));
  pfv::Flow flow(seepage(), {}, tight(), world());
  flow.evaluate(part.view());
  EXPECT_THROW(flow.advance(part.view(), 1e-3, {pfv::Coupling::staged, nullptr, true, 1.0, {}}), pfv::InputError);
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(part.ids.size());
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, part.ids.size());
  const pfv::GrainDynamics dynamics{{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  EXPECT_THROW(flow.advance(part.view(), 1e-3, pfv::Step::with(pfv::Coupling::implicit, dynamics)), pfv::InputError);
}
