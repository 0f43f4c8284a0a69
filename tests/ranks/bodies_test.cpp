// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies and obstacles on several ranks: what lies within them, what they close off, how they yield.
#include "as_on_one_rank.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/error.hpp"
#include "pfv/obstacle.hpp"
#include "support/clumps.hpp"
#include "support/meshes.hpp"

#include <limits>
#include <string>
#include <utility>

namespace {

using support::Clumps;

pfv::Box drained() {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(2.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(-1.0);
  return box;
}

/// The spheres of a dense packing, larger, those of one cube of a grid in one body: bodies that overlap each other.
pfv::PackingArrays conglomerates(int spheres, int cubes, double larger, int every = 1) {
  pfv::PackingArrays packing = dense_bed(spheres);
  packing.radii *= larger;
  packing.bodies.resize(packing.ids.size());
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    const Eigen::Array3i cube = (packing.positions.col(k).array() * cubes).cast<int>().min(cubes - 1);
    const int number = (cube[2] * cubes + cube[1]) * cubes + cube[0];
    packing.bodies[k] = number % every == 0 ? number / every : -1;
  }
  set_in_motion(packing, 4);
  return packing;
}

Clumps tetrahedra(int cells = 3, double radius = 0.07) {
  Clumps clumps(support::tetrahedron_shape(1.3 * radius), radius, cells, 5);
  clumps.stir(1.0);
  return clumps;
}

/// Of the bodies those arms whose spheres this rank has.
std::vector<pfv::RigidBody> with_own_arms(const Clumps& clumps, const std::vector<int>& columns) {
  std::vector<pfv::RigidBody> bodies = clumps.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<int> own;
    for (std::size_t i = 0; i < clumps.members[b].size(); ++i)
      if (std::binary_search(columns.begin(), columns.end(), clumps.members[b][i])) own.push_back(static_cast<int>(i));
    bodies[b].arms = Eigen::Matrix3Xd(clumps.bodies[b].arms(Eigen::all, own));
  }
  return bodies;
}

/// What a rank tells of the motion of its spheres.
struct OwnDynamics {
  Eigen::VectorXd masses;
  Eigen::Matrix3Xd others, torques;
  std::vector<pfv::RigidBody> bodies;

  OwnDynamics(const Clumps& clumps, const std::vector<int>& columns)
      : masses(clumps.masses(columns)), others(clumps.others(Eigen::all, columns)),
        torques(clumps.other_torques(Eigen::all, columns)), bodies(with_own_arms(clumps, columns)) {}
  pfv::GrainDynamics view() const {
    return {{masses.data(), masses.size()}, {others.data(), 3, others.cols()}, {},
            {torques.data(), 3, torques.cols()}, {nullptr, 0}, bodies};
  }
};

}  // namespace

TEST(SharedBodies, ClumpsThatMoveInASeepage) {
  expect_as_on_one_rank({tetrahedra(in_long(4, 3)).packing, drained(), {}, tight(), 0.0, every_deal});
}

/// What bodies close off beside each other shares the pressure of a pore that may be another rank's.
TEST(SharedBodies, BodiesThatOverlapAndCloseOffPores) {
  expect_as_on_one_rank({conglomerates(in_long(300, 150), 3, 1.1), drained(), {}, tight(), 0.0, {Deal::by_place}});
  const pfv::PackingArrays packing = conglomerates(300, 3, 1.25);
  expect_as_on_one_rank({packing, drained(), {}, tight(), 0.0, {Deal::at_random, Deal::all_to_one}});
  pfv::Flow flow(drained(), {}, tight(), world());
  flow.evaluate(part_of(packing, own_columns(packing, Deal::at_random)).view());
  EXPECT_GT(flow.report().counts.joined_pores, 20);
  EXPECT_GT(flow.report().counts.enclosed_pores, 50);
}

TEST(SharedBodies, FluxesIntoWhatBodiesCloseOff) {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  box[pfv::Face::xhi].boundary = pfv::Boundary::flux(-3e-4);
  box.patches.push_back({pfv::Face::zhi, {0.1, 0.9, 0.1, 0.9}, pfv::Boundary::pressure(0.5)});
  const pfv::PackingArrays packing = conglomerates(in_long(400, 200), in_long(4, 3), 1.2);
  expect_as_on_one_rank({packing, box, {}, tight(), 0.0, {Deal::by_place, Deal::at_random}});
}

TEST(SharedBodies, NoPressureIsImposed) {
  pfv::PackingArrays packing = conglomerates(in_long(300, 150), 3, 1.2);
  packing.velocities.setZero();
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  pfv::Box box;
  box[pfv::Face::zhi].velocity = -1e-3;
  expect_as_on_one_rank({packing, box, fluid, tight(), 1e-3, {Deal::at_random}});
}

/// Bodies that reach across the sides of a cell, and close off pores there.
TEST(SharedBodies, InAPeriodicCell) {
  pfv::Box box = drained();
  box.periodic = {true, true, false};
  box.pressure_gradient = {12.0, -7.0, 0.0};
  expect_as_on_one_rank({conglomerates(in_long(150, 100), 3, 1.2), box, {}, tight(), 0.0, {Deal::by_place, Deal::at_random}});
  expect_as_on_one_rank({tetrahedra(3, 0.03).packing, box, {}, tight(), 0.0, {Deal::at_random}});
}

/// Clumps in much water are braked as a whole, by whatever ranks have their spheres.
TEST(SharedBodies, ClumpsInOpenWater) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  const Clumps clumps = tetrahedra(3, 0.03);
  expect_as_on_one_rank({clumps.packing, box, {}, tight(), 0.0, every_deal});
  pfv::Flow flow(box, {}, tight(), world());
  flow.evaluate(part_of(clumps.packing, own_columns(clumps.packing, Deal::at_random)).view());
  EXPECT_GT(flow.report().counts.open_water, 20);
}

TEST(SharedBodies, AnObstacleAmongGrains) {
  pfv::PackingArrays packing = dense_bed(in_long(700, 200));
  const Eigen::Vector3d middle(0.5, 0.5, 0.5);
  std::vector<int> kept;
  for (int k = 0; k < packing.ids.size(); ++k)
    if ((packing.positions.col(k) - middle).norm() > 0.22 + packing.radii[k]) kept.push_back(k);
  packing = pfv::columns_of(packing, kept);
  set_in_motion(packing, 4);
  const pfv::Obstacle ball = pfv::obstacle_of_mesh(pfv_test::sphere_mesh(middle, 0.22, in_long(2, 1)), packing.radii.mean(), "ball ");
  pfv::ObstacleMotion motion;
  motion.velocity = Eigen::Vector3d(0.1, 0.2, -0.3);
  motion.spin = Eigen::Vector3d(0.0, 1.0, 0.0);
  motion.pivot = middle;
  pfv::PackingArrays all = packing;
  pfv::add_obstacle(all, ball, motion, 100000, drained());
  pfv::Options sheared = tight();
  sheared.shear_viscous = true;
  const std::vector<Deal> deals{Deal::by_place, Deal::at_random};
  expect_as_on_one_rank({all, drained(), {}, tight(), 0.0, in_long(deals, {Deal::by_place})});
  expect_as_on_one_rank({all, drained(), {}, sheared, 0.0, in_long(deals, {Deal::at_random})});
  pfv::Flow one(drained(), {}, tight());
  const pfv::ObstacleLoad expected = pfv::load_on(all.view(), one.evaluate(all.view()), packing.ids.size(), ball.size(), middle);
  for (const Deal deal : deals) {
    // in parts, as a host adds it to the grains of each rank
    const std::vector<int> columns = own_columns(packing, deal);
    pfv::PackingArrays part = part_of(packing, columns);
    pfv::ObstaclePart own;
    for (int k = 0; k < ball.size(); ++k)
      if (k % world()->count() == world()->own()) own.spheres.push_back(k);
    pfv::add_obstacle(part, ball, own, motion, 100000, drained());
    pfv::Flow shared(drained(), {}, tight(), world());
    pfv::ObstacleLoad found = pfv::load_on(part.view(), shared.evaluate(part.view()), static_cast<Eigen::Index>(columns.size()),
                                           static_cast<Eigen::Index>(own.spheres.size()), middle);
    world()->add(found.force.data(), 3);
    world()->add(found.moment.data(), 3);
    EXPECT_LT((found.force - expected.force).norm(), 1e-9 * expected.force.norm());
    EXPECT_LT((found.moment - expected.moment).norm(), 1e-8 * expected.force.norm());
    EXPECT_LT(shared.report().force_balance_error, 1e-12);
  }
}

/// Bodies drawn at random from spheres that overlap: what one rank finds, or its refusal.
TEST(SharedBodies, BodiesAtRandom) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= in_long(12u, 8u); ++seed) {
    support::Random random(seed);
    pfv::PackingArrays packing = pfv::dense_packing(150, 0.6, 0.3, seed);
    packing.radii *= random(1.0, 1.3);
    packing.bodies.resize(packing.ids.size());
    const int bodies = static_cast<int>(random(1.0, 40.0));
    for (int& body : packing.bodies) body = static_cast<int>(random(-1.0, bodies));
    set_in_motion(packing, seed);
    pfv::Fluid fluid;
    if (seed % 2 == 0) fluid.bulk_modulus = 1e3;
    pfv::Box box = drained();
    if (seed % 3 == 0) box[pfv::Face::xlo].boundary = pfv::Boundary::flux(1e-3);
    const std::vector<int> columns = own_columns(packing, seed % 2 ? Deal::at_random : Deal::by_place);
    const auto solved = [&](const pfv::PackingArrays& part, std::shared_ptr<const pfv::Ranks> ranks, std::string& refusal) {
      pfv::Options options = tight();
      options.shear_viscous = seed % 4 < 2;
      pfv::Flow flow(box, fluid, options, ranks);
      try {
        const Eigen::Matrix3Xd forces = flow.evaluate(part.view(), 1e-3).total;
        return std::pair(forces, flow.report());
      } catch (const pfv::Error& error) {
        refusal = error.what();
        return std::pair(Eigen::Matrix3Xd(3, 0), pfv::Report());
      }
    };
    std::string of_one, of_all;
    const auto [expected, one] = solved(packing, nullptr, of_one);
    const auto [found, all] = solved(part_of(packing, columns), world(), of_all);
    ASSERT_EQ(of_all.empty(), of_one.empty()) << "seed " << seed << ": " << of_one << " / " << of_all;
    if (!of_one.empty()) continue;
    ++compared;
    EXPECT_LT(difference_of(found, expected, columns).rms, 1e-8) << "seed " << seed;
    EXPECT_EQ(all.counts.enclosed_pores, one.counts.enclosed_pores) << "seed " << seed;
    EXPECT_EQ(all.counts.joined_pores, one.counts.joined_pores) << "seed " << seed;
    EXPECT_EQ(all.counts.open_water, one.counts.open_water) << "seed " << seed;
    EXPECT_EQ(all.unknowns, one.unknowns) << "seed " << seed;
  }
  EXPECT_GE(compared, in_long(6, 4));
}

TEST(SharedBodies, TheSameBytesTwice) {
  const pfv::PackingArrays packing = conglomerates(in_long(300, 150), 3, 1.2);
  const pfv::PackingArrays part = part_of(packing, own_columns(packing, Deal::at_random));
  const auto forces = [&] {
    pfv::Flow flow(drained(), {}, tight(), world());
    return Eigen::Matrix3Xd(flow.evaluate(part.view()).total);
  };
  EXPECT_EQ(forces(), forces());
}

TEST(SharedBodies, StagedStepsFarAboveTheLimit) {
  Clumps clumps = tetrahedra(3);
  clumps.others.row(2) = -9.81 * clumps.masses.transpose();
  clumps.bodies[2].other_force = Eigen::Vector3d(0.0, 50.0, -80.0);
  clumps.bodies[2].other_torque = Eigen::Vector3d(1.0, 0.0, 2.0);
  clumps.bodies[5].masses.setConstant(std::numeric_limits<double>::infinity());
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Options options = tight();
  options.outside = pfv::OutsideGrains::leave_out;
  clumps.packing.positions(0, clumps.members[4][0]) = 1.01;  // acts on its body from outside of the fluid
  for (const Deal deal : in_long(every_deal, {Deal::at_random})) {
    const std::vector<int> columns = own_columns(clumps.packing, deal);
    const pfv::PackingArrays part = part_of(clumps.packing, columns);
    const OwnDynamics own(clumps, columns);
    const pfv::GrainDynamics of_one = clumps.dynamics(), of_all = own.view();
    pfv::Flow one(box, {}, options), all(box, {}, options, world());
    one.evaluate(clumps.packing.view(), 1e-3);
    all.evaluate(part.view(), 1e-3);
    const double limit = one.time_step_limit(clumps.masses, {}, clumps.bodies);
    EXPECT_NEAR(all.time_step_limit(own.masses, {}, own.bodies) / limit, 1.0, 0.005);
    expect_staged_steps_agree(one, all, {clumps.packing, columns, of_one, of_all}, 30.0 * limit, in_long(3, 2));
  }
}

TEST(SharedBodies, PressuresGoOnToNewNetworksAndOtherRanks) {
  const double dt = 1e-3;
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  pfv::PackingArrays packing = conglomerates(in_long(250, 100), 3, 1.15);
  packing.velocities *= 0.3;
  pfv::Flow one(drained(), fluid, tight()), all(drained(), fluid, tight(), world());
  const auto compare = [&](pfv::Flow& some, pfv::Flow& alone, Deal deal, const char* when) {
    const std::vector<int> columns = own_columns(packing, deal);
    const pfv::Forces& expected = alone.step(packing.view(), dt);
    const pfv::Forces& found = some.step(part_of(packing, columns).view(), dt);
    EXPECT_LT(difference_of(found.total, expected.total, columns).rms, 1e-9) << when;
  };
  compare(all, one, Deal::by_place, "at first");
  packing.positions += 0.02 * packing.velocities;
  one.rebuild();
  all.rebuild();
  compare(all, one, Deal::at_random, "on a new network, dealt anew");
  one.rebuild();
  all.rebuild();
  one.evaluate(packing.view(), dt);
  all.evaluate(part_of(packing, own_columns(packing, Deal::by_place)).view(), dt);
  const pfv::FlowState state = one.state(), shared = all.state();
  EXPECT_EQ(shared.pore_pressures.size(), world()->own() == 0 ? state.pore_pressures.size() : 0);
  pfv::Flow other(drained(), fluid, tight(), world()), alone(drained(), fluid, tight());
  other.set_state(shared);
  alone.set_state(state);
  compare(other, alone, Deal::all_to_one, "from the state of ranks");
}

TEST(SharedBodies, RanksThatGiveDifferentBodiesAreRefused) {
  Clumps clumps = tetrahedra(3);
  const std::vector<int> columns = own_columns(clumps.packing, Deal::by_place);
  const pfv::PackingArrays part = part_of(clumps.packing, columns);
  OwnDynamics own(clumps, columns);
  pfv::Flow flow(drained(), {}, tight(), world());
  flow.evaluate(part.view());
  if (world()->own() == 0) own.bodies.push_back(own.bodies.back()), own.bodies.back().arms.resize(3, 0);
  EXPECT_THROW(flow.time_step_limit(own.masses, {}, own.bodies), pfv::InputError);
}
