// SPDX-License-Identifier: GPL-3.0-or-later
// Packings that repeat, on several ranks: the network, and what flows through it, is that of one rank.
#include "as_on_one_rank.hpp"
#include "same_network.hpp"

#include "problem/lattice.hpp"
#include "support/adversarial.hpp"
#include "support/containers.hpp"
#include "support/random_beds.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace {

pfv::Box periodic_box(bool x, bool y, bool z, const Eigen::Vector3d& tilt = Eigen::Vector3d::Zero()) {
  pfv::Box box;
  box.periodic = {x, y, z};
  box.tilt = tilt;
  return box;
}

/// Turned so that many grains stand at the sides, some beyond them.
pfv::PackingArrays moved(pfv::PackingArrays packing, const Eigen::Vector3d& by) {
  packing.positions.colwise() += by;
  return packing;
}

}  // namespace

TEST(PeriodicRanks, NetworkIsThatOfOneRankForADenseBed) {
  const pfv::PackingArrays bed = numbered(dense_bed(in_long(120, 60)));
  for (const pfv::Box& box : {periodic_box(true, true, true), periodic_box(true, true, false), periodic_box(false, false, true)})
    expect_same(bed, box, every_deal);
}

TEST(PeriodicRanks, NetworkIsThatOfOneRankWhereGrainsStandBeyondTheSides) {
  const pfv::PackingArrays bed = numbered(dense_bed(in_long(200, 60)));
  for (const double way : {0.013, 0.5, -3.71})
    expect_same(moved(bed, {way, 0.0, -way}), periodic_box(true, false, true), {Deal::by_place});
}

TEST(PeriodicRanks, NetworkIsThatOfOneRankInATiltedCell) {
  const pfv::PackingArrays bed = numbered(dense_bed(in_long(200, 60)));
  for (const Eigen::Vector3d& tilt : {Eigen::Vector3d(0.3, -0.2, 0.45), Eigen::Vector3d(0.5, 0.0, 0.0)})
    expect_same(bed, periodic_box(true, true, true, tilt), {Deal::by_place, Deal::at_random});
}

/// An image is a neighbour of the grain itself; ranks without a grain have nothing to do.
TEST(PeriodicRanks, NetworkIsThatOfOneRankForFewGrains) {
  for (const int count : {1, 2, 3, 8, 30})
    for (const auto& box : {periodic_box(true, true, true), periodic_box(false, true, false)})
      expect_same(numbered(support::random_packing(count, 0.05, 0.15, 4)), box, {Deal::by_place});
}

TEST(PeriodicRanks, NetworkIsThatOfOneRankForUnlikeSpheresAndVoids) {
  const pfv::PackingArrays unlike = support::random_packing(in_long(200, 80), 0.015, 0.075, 2);
  expect_same(numbered(unlike), periodic_box(true, true, true), {Deal::by_place});
  const pfv::PackingArrays hollow = support::without_the_middle(dense_bed(in_long(400, 150)), 0.35);
  expect_same(numbered(hollow), periodic_box(true, true, true), {Deal::by_place});
  pfv::Box tall = periodic_box(true, true, false);
  tall.upper[2] = 3.0;  // much water above the bed
  expect_same(numbered(dense_bed(in_long(200, 60))), tall, {Deal::by_place});
}

TEST(PeriodicRanks, NetworkIsThatOfOneRankForALatticeWhosePoresMerge) {
  const pfv::Box around = periodic_box(true, true, true), along = periodic_box(true, false, false);
  const int cells = in_long(4, 3);
  expect_same(support::lattice(support::Lattice::sc, cells), around, {Deal::by_place});
  expect_same(support::lattice(support::Lattice::fcc, cells), along, {Deal::by_place});
  if (!in_long(true, false)) return;
  expect_same(support::lattice(support::Lattice::sc, cells), along, {Deal::by_place});
  expect_same(support::lattice(support::Lattice::fcc, cells), around, {Deal::by_place});
}

namespace {

pfv::Box driven_box(bool z = true) {
  pfv::Box box = periodic_box(true, true, z);
  box.pressure_gradient = {12.0, -7.0, z ? 3.0 : 0.0};
  return box;
}

/// Level, too: a cell that is periodic all around has none of its own.
pfv::Region well(double pressure) {
  return {Eigen::Vector3d::Constant(0.5), Eigen::Vector3d::Constant(0.5), pfv::Boundary::pressure(pressure)};
}

pfv::PackingArrays moving_bed(int count) {
  pfv::PackingArrays bed = numbered(dense_bed(count));
  set_in_motion(bed, 3);
  bed.velocities *= 1e-3;
  return bed;
}

}  // namespace

TEST(PeriodicRanks, FlowOfAGradientIsThatOfOneRank) {
  pfv::Box box = driven_box();
  box.regions = {well(5.0)};
  Case what{numbered(dense_bed(in_long(120, 60))), box};
  what.options.split_forces = true;
  what.deals = {Deal::by_place, Deal::at_random};
  expect_as_on_one_rank(what);
  box.tilt = {0.3, -0.2, 0.45};
  expect_as_on_one_rank({what.packing, box});
}

/// Without any pressure the level of the pressures is one of those that there are: forces do not depend on it.
TEST(PeriodicRanks, ForcesAndPermeabilityOfACellThatIsPeriodicAllAroundAreThoseOfOneRank) {
  for (const bool driven : {true, false}) {
    const pfv::Box box = driven ? driven_box() : periodic_box(true, true, true);
    const pfv::PackingArrays bed = numbered(dense_bed(in_long(120, 60)));
    const std::vector<int> columns = own_columns(bed, Deal::by_place);
    const pfv::PackingArrays part = part_of(bed, columns);
    pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
    const Eigen::Matrix3Xd expected = one.evaluate(bed.view()).total, found = all.evaluate(part.view()).total;
    if (driven) {
      EXPECT_LT(difference_of(found, expected, columns).rms, 1e-9);
    } else {
      EXPECT_TRUE(found.isZero(0.0));
    }
    expect_reports_agree(all.report(), one.report());
  }
}

TEST(PeriodicRanks, PressuresAndFluxesAcrossPeriodsAlong) {
  pfv::Box box = driven_box(false);
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(10.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  expect_as_on_one_rank({moving_bed(in_long(120, 60)), box});
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  expect_as_on_one_rank({moving_bed(in_long(120, 60)), box});
}

TEST(PeriodicRanks, MovingGrainsAndACellThatStretches) {
  pfv::Box box = driven_box();
  box.regions = {well(5.0)};
  expect_as_on_one_rank({moving_bed(in_long(120, 60)), box});
  box[pfv::Face::xhi].velocity = -2e-3;
  box[pfv::Face::zlo].velocity = 1e-3;
  expect_as_on_one_rank({moving_bed(in_long(120, 60)), box});
  Case few{numbered(support::random_packing(6, 0.05, 0.15, 4)), box};
  set_in_motion(few.packing, 5);
  expect_as_on_one_rank(few);
}

namespace {

/// From z = 0 to 1, radius or half width 0.5, closed by its periods.
pfv::Container tube(bool round) {
  const Eigen::Vector3d along = Eigen::Vector3d::UnitZ(), middle(0.5, 0.5, 0.0);
  std::vector<pfv::ContainerFace> faces{support::plane_face("start", -along, middle), support::plane_face("end", along, middle + along)};
  if (round) faces.push_back(support::cylinder_face("shell", along, middle, 0.5));
  for (int i = 0; i < 6 && !round; ++i) {
    const Eigen::Vector3d out(std::cos(M_PI / 3.0 * i + 0.2), std::sin(M_PI / 3.0 * i + 0.2), 0.0);
    faces.push_back(support::plane_face("side" + std::to_string(i), out, middle + 0.5 * out));
  }
  pfv::Container container = pfv::container_of(faces);
  container.periodic[2] = true;
  container.pressure_gradient[2] = -1.0;
  container.regions = {{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, pfv::Boundary::pressure(5.0)}};
  return container;
}

}  // namespace

TEST(PeriodicRanks, PipesThatRepeatAlongTheirAxis) {
  pfv::Options options = tight();
  options.torques = false;  // there are none beside a cylinder
  for (const bool round : {true, false}) {
    support::Random random(5);
    const pfv::PackingArrays bed = numbered(support::spheres_in(tube(round), 150, 0.07, random));
    const std::vector<Deal> deals{Deal::by_place, Deal::at_random};
    expect_same(bed, tube(round), deals);
    pfv::Flow one(tube(round), {}, options);
    const Eigen::Matrix3Xd expected = one.evaluate(bed.view()).total;
    for (const Deal deal : deals) {
      const std::vector<int> columns = own_columns(bed, deal);
      pfv::Flow all(tube(round), {}, options, world());
      EXPECT_LT(difference_of(all.evaluate(part_of(bed, columns).view()).total, expected, columns).rms, 1e-9);
      expect_reports_agree(all.report(), one.report());
    }
  }
}

TEST(PeriodicRanks, GrainsThatSettleInOpenWater) {
  pfv::Box box = periodic_box(true, true, false);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Fluid fluid;
  fluid.gravity = {0.0, 0.0, -9.81};
  pfv::Options options = tight();
  options.shear_viscous = true;
  for (const int grains : {3, 60}) {
    Case what{numbered(support::random_packing(grains, 0.02, 0.04, 3)), box, fluid, options};
    set_in_motion(what.packing, 5);
    expect_as_on_one_rank(what);
  }
}

TEST(PeriodicRanks, GrainsThatCrossTheSides) {
  const double dt = 1e-3;
  pfv::Box box = driven_box();
  box.regions = {well(5.0)};
  for (const int count : {in_long(80, 51), 7}) {
    pfv::PackingArrays packing = numbered(count > 50 ? dense_bed(count) : support::random_packing(count, 0.05, 0.15, 4));
    set_in_motion(packing, 3);
    packing.velocities *= 0.3;
    packing.velocities.colwise() += Eigen::Vector3d(40.0, 0.0, -25.0);
    pfv::Flow one(box, {}, tight()), all(box, {}, tight(), world());
    const int steps = in_long(3, 1);  // of each way to deal them
    for (int step = 0; step < 3 * steps; ++step) {
      one.rebuild();  // where grains are dealt anew, ranks make networks more
      all.rebuild();
      const std::vector<int> columns = own_columns(packing, every_deal[static_cast<std::size_t>(step / steps)]);
      const pfv::Forces& expected = one.step(packing.view(), dt);
      const pfv::Forces& found = all.step(part_of(packing, columns).view(), dt);
      EXPECT_LT(difference_of(found.total, expected.total, columns).rms, 1e-9) << "step " << step;
      packing.positions += dt * packing.velocities;
      for (double& x : packing.positions.reshaped()) x -= std::floor(x);
    }
  }
}

namespace {

/// A flow on one rank and on all, of a compressible fluid, and the grains of both.
struct Pair {
  pfv::Box box;
  pfv::Flow one, all;
  pfv::PackingArrays packing;

  Pair(const pfv::Box& in, const pfv::Fluid& fluid, pfv::PackingArrays grains)
      : box(in), one(in, fluid, tight()), all(in, fluid, tight(), world()), packing(std::move(grains)) {}
  void rebuild() {
    one.rebuild();
    all.rebuild();
  }
  /// Forces and pressures of one step, side by side.
  void step(double dt, Deal deal) {
    const std::vector<int> columns = own_columns(packing, deal);
    const pfv::Forces& expected = one.step(packing.view(), dt);
    const pfv::Forces& found = all.step(part_of(packing, columns).view(), dt);
    EXPECT_LT(difference_of(found.total, expected.total, columns).rms, 1e-9);
    const double pressure = expected.sphere_pressure.cwiseAbs().maxCoeff();
    double apart = 0.0;
    for (std::size_t i = 0; i < columns.size(); ++i)
      apart = std::max(apart, std::abs(found.sphere_pressure[static_cast<Eigen::Index>(i)] - expected.sphere_pressure[columns[i]]));
    EXPECT_LE(world()->largest(apart), 1e-9 * pressure);
    EXPECT_NEAR(all.mean_pressure(), one.mean_pressure(), 1e-9 * pressure);
    EXPECT_NEAR(*all.report().fluid_balance_error, *one.report().fluid_balance_error, 1e-9);
    EXPECT_EQ(all.retriangulations(), one.retriangulations());
  }
  /// As a host does that wraps grains.
  void move(double dt) {
    packing.positions += dt * packing.velocities;
    const pfv::Lattice lattice{box.upper - box.lower, box.tilt, {box.periodic[0], box.periodic[1], box.periodic[2]}};
    for (auto place : packing.positions.colwise())
      place -= lattice.displacement(lattice.periods(place - box.lower, [](double x) { return std::floor(x); }));
  }
};

pfv::Fluid compressible() {
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  return fluid;
}

pfv::PackingArrays drifting(int count) {
  pfv::PackingArrays packing = numbered(count > 50 ? dense_bed(count) : support::random_packing(count, 0.05, 0.15, 4));
  set_in_motion(packing, 3);
  packing.velocities *= 0.3;
  packing.velocities.colwise() += Eigen::Vector3d(40.0, 0.0, -25.0);
  return packing;
}

}  // namespace

/// From network to network with the pores, however the grains are dealt. Networks are asked for at each step, since ranks
/// make one more where grains are dealt anew.
TEST(PeriodicRanks, PressuresOfACompressibleFluidGoAlong) {
  const int many = in_long(80, 51);
  for (const auto& [count, tilt] : {std::pair(many, 0.0), std::pair(7, 0.0), std::pair(many, 0.3), std::pair(300, 0.0)}) {
    if (count > in_long(300, many)) continue;
    SCOPED_TRACE(count);
    pfv::Box box = driven_box();
    box.tilt = tilt * Eigen::Vector3d(1.0, -0.7, 1.5);
    Pair flows(box, compressible(), drifting(count));
    const int steps = in_long(2, 1);  // of each way to deal them
    for (int step = 0; step < 3 * steps; ++step) {
      SCOPED_TRACE(step);
      flows.rebuild();
      flows.step(1e-3, every_deal[static_cast<std::size_t>(step / steps)]);
      flows.move(1e-3);
    }
  }
}

/// Where the strain of the pores asks for networks, the account is another: the fluid takes up what is missing.
TEST(PeriodicRanks, ACompressibleFluidWhosePoresStrain) {
  const std::vector<Deal> deals{Deal::at_random, Deal::all_to_one};  // which leave each grain where it is
  for (const Deal deal : in_long(deals, {deals[0]})) {
    pfv::Box box = driven_box(false);
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(2.0);
    box[pfv::Face::zlo].velocity = 0.1;
    pfv::PackingArrays packing = drifting(in_long(150, 60));
    packing.velocities.row(2).setZero();
    Pair flows(box, compressible(), packing);
    for (int step = 0; step < 10; ++step) {
      SCOPED_TRACE(step);
      flows.step(1e-3, deal);
      flows.move(1e-3);
      flows.box.lower[2] += 1e-3 * 0.1;
      flows.one.set_box(flows.box);
      flows.all.set_box(flows.box);
    }
    EXPECT_GE(flows.one.retriangulations(), 4);
  }
}

/// Undrained: what the cell loses is pressed together, over several networks, while grains cross its sides.
TEST(PeriodicRanks, AnUndrainedCellThatShrinks) {
  const double dt = 1e-4, rate = 1.0;
  Pair flows(periodic_box(true, true, true), compressible(), drifting(in_long(100, 60)));
  flows.box[pfv::Face::xhi].velocity = -rate;
  const double solid = 4.0 / 3.0 * M_PI * flows.packing.radii.array().cube().sum();
  double before = 1.0 - solid, pressed = 0.0;
  for (int step = 0; step < in_long(8, 5); ++step) {
    SCOPED_TRACE(step);
    flows.box.upper[0] -= dt * rate;
    flows.one.set_box(flows.box);
    flows.all.set_box(flows.box);
    flows.step(dt, Deal::at_random);
    const double now = flows.box.upper[0] - solid;
    pressed += std::log(before / now);
    before = now;
    EXPECT_NEAR(flows.all.mean_pressure() / (1e3 * pressed), 1.0, 2e-3);
    flows.move(dt);
    if (step % 3 == 2) flows.rebuild();
  }
}

/// The cell keeps its volume, so that the fluid keeps its mean pressure.
TEST(PeriodicRanks, ACompressibleFluidAtConstantVolume) {
  pfv::PackingArrays packing = moving_bed(in_long(100, 60));
  packing.velocities *= 1e3;
  Pair flows(periodic_box(true, true, true), compressible(), packing);
  for (int step = 0; step < in_long(6, 3); ++step) {
    flows.step(1e-3, Deal::at_random);
    EXPECT_LT(std::abs(flows.all.mean_pressure()), 1e-9 * 1e3);
    flows.move(1e-3);
  }
  EXPECT_GE(flows.one.retriangulations(), 2);
}

TEST(PeriodicRanks, AGradientThatChangesWhereGrainsCross) {
  Pair flows(driven_box(), compressible(), drifting(in_long(100, 60)));
  for (int step = 0; step < in_long(6, 3); ++step) {
    flows.box.pressure_gradient *= -1.5;
    flows.one.set_box(flows.box);
    flows.all.set_box(flows.box);
    flows.rebuild();
    flows.step(1e-3, Deal::by_place);
    flows.move(1e-3);
  }
}

TEST(PeriodicRanks, AStateOfACompressibleFluidGoesFromRanksToOneAndBack) {
  const double dt = 1e-3;
  for (const int count : {in_long(80, 51), 7}) {
    Pair flows(driven_box(), compressible(), drifting(count));
    for (int step = 0; step < in_long(3, 2); ++step) {
      flows.rebuild();
      flows.step(dt, Deal::by_place);
      flows.move(dt);
    }
    flows.rebuild();
    const std::vector<int> columns = own_columns(flows.packing, Deal::by_place);
    flows.one.evaluate(flows.packing.view(), dt);
    flows.all.evaluate(part_of(flows.packing, columns).view(), dt);
    const pfv::FlowState of_one = flows.one.state(), of_all = flows.all.state();
    ASSERT_EQ(of_all.pore_pressures.size(), world()->own() == 0 ? of_one.pore_pressures.size() : 0);
    double apart = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < of_all.pore_pressures.size(); ++p) {
      apart = std::max(apart, std::abs(of_all.pore_pressures[p] - of_one.pore_pressures[p]));
      largest = std::max(largest, std::abs(of_one.pore_pressures[p]));
    }
    EXPECT_LE(apart, 1e-8 * largest);
    for (const Deal deal : in_long(every_deal, {Deal::by_place, Deal::at_random})) {
      Pair again(driven_box(), compressible(), flows.packing);
      again.one.set_state(of_one);
      again.all.set_state(deal == Deal::by_place ? of_all : of_one);
      again.step(dt, deal);
    }
  }
}

TEST(PeriodicRanks, StagedStepsAsOnOneRank) {
  const pfv::PackingArrays packing = moving_bed(in_long(120, 50));
  const std::vector<int> columns = own_columns(packing, Deal::by_place);
  const Loads loads{1e4 * packing.radii.array().cube(), Eigen::Matrix3Xd::Zero(3, packing.ids.size())}, own = loads.of(columns);
  for (const pfv::Fluid& fluid : {pfv::Fluid{}, compressible()}) {
    pfv::Flow one(driven_box(), fluid, tight()), all(driven_box(), fluid, tight(), world());
    one.evaluate(packing.view(), 1e-3);
    const double dt = 30.0 * one.time_step_limit(loads.masses, loads.pistons);
    expect_staged_steps_agree(one, all, {packing, columns, loads.view(), own.view()}, dt, in_long(2, 1));
  }
}

/// PFV_RANK_PACKINGS: how many times four.
TEST(PeriodicRanks, NetworkIsThatOfOneRankForWhatIsHardToTriangulate) {
  const char* wanted = std::getenv("PFV_RANK_PACKINGS");
  const int count = wanted ? std::atoi(wanted) / 4 : in_long(24, 12);
  support::Random random(12);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("packing " + std::to_string(i));
    const auto kind = static_cast<std::size_t>(i) % (support::adversarial::kinds.size() + 1);
    const bool plain = kind == support::adversarial::kinds.size();
    const pfv::PackingArrays packing =
        numbered(plain ? support::random_packing(support::whole(random, 4, 100), 0.02, random(0.03, 0.09),
                                                 static_cast<std::uint64_t>(i))
                       : support::packing_of(support::adversarial::spheres_of(kind, random)));
    const int axes = support::whole(random, 1, 7);
    pfv::Box box = periodic_box(axes & 1, axes & 2, axes & 4);
    if (axes == 7 && random() < 0.5) box.tilt = 0.5 * random.in_cube();
    expect_same(packing, box, {i % 2 ? Deal::at_random : Deal::by_place});
    if (HasFailure()) return;
  }
}
