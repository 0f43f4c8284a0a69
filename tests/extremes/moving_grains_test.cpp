// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that close pores and open them again, that come and go at each step, that jump.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace moving_grains_test {
namespace {

using namespace support;

constexpr double dt = 1e-3;

pfv::Options lenient() {
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  return options;
}

void expect_sound(const pfv::Flow& flow) {
  EXPECT_TRUE(flow.forces().total.allFinite());
  EXPECT_TRUE(flow.pore_pressures().allFinite());
  const pfv::Report report = flow.report();
  record_balances(report);
  EXPECT_LT(std::abs(report.mass_error), 1e-9);
  EXPECT_LT(report.force_balance_error, 1e-13);
}

/// Four spheres whose discs close the pore between them where their distances fall below 1.73 radii.
class Breathing {
 public:
  pfv::PackingArrays at(double time) const {
    auto packing = packing_of({});
    std::vector<Sphere> spheres;
    Eigen::Matrix3Xd velocities(3, 4);
    const double edge = 0.36 - 0.07 * std::sin(time), rate = -0.07 * std::cos(time);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d way = corners[static_cast<std::size_t>(i)] / (2.0 * std::sqrt(2.0));
      const Eigen::Vector3d x = Eigen::Vector3d::Constant(0.5) + edge * way;
      spheres.push_back({x[0], x[1], x[2], 0.18});
      velocities.col(i) = rate * way;
    }
    packing = packing_of(spheres);
    packing.velocities = velocities;
    return packing;
  }

 private:
  std::array<Eigen::Vector3d, 4> corners{Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1),
                                         Eigen::Vector3d(-1, 1, -1), Eigen::Vector3d(-1, -1, 1)};
};

TEST(PoresThatClose, AndOpenAgainInACompressibleFluidGoOn) {
  pfv::Fluid fluid = viscosity_one();
  fluid.bulk_modulus = 1e6;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), fluid);
  const Breathing grains;
  double highest = 0.0, last = 0.0;
  for (double time = 0.0; time < 6.3; time += 0.02) {
    flow.step(grains.at(time).view(), 0.02);
    expect_sound(flow);
    last = flow.pressure_at({0.5, 0.5, 0.5});
    highest = std::max(highest, last);
  }
  EXPECT_GT(highest, 1e4);                  // the fluid in the closed pore is compressed
  EXPECT_LT(std::abs(last), 1e-2 * highest);  // and let go
}

// Incompressible: while the pore is closed its volume cannot change; the Flow says so and recovers.
TEST(PoresThatClose, InAnIncompressibleFluidAreNamedUntilTheyOpen) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  const Breathing grains;
  int refused = 0, after = 0;
  for (double time = 0.0; time < 6.3; time += 0.02) {
    const auto packing = grains.at(time);
    try {
      flow.step(packing.view(), 0.02);
      expect_sound(flow);
      if (refused > 0) ++after;
    } catch (const pfv::InputError& error) {
      ++refused;
      expect_line(error.what(), "spheres 1, 2, 3, 4");
      expect_line(error.what(), "bulk modulus");
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(after, 10);
}

TEST(ComingAndGoing, AtEachStepGivesTheForcesOfAFreshFlow) {
  const auto all = random_packing(60, 0.05, 0.1, 3);
  Random random(4);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), lenient());
  for (int step = 0; step < 40; ++step) {
    std::vector<Sphere> there;
    for (int k = 0; k < all.radii.size(); ++k)
      if (random() < 0.8)
        there.push_back({all.positions(0, k), all.positions(1, k), all.positions(2, k),
                         all.radii[k]});
    auto packing = packing_of(there);
    for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
      packing.ids[k] = 1000 * (step + 1) + k;  // as newly inserted ones have
    const Eigen::Matrix3Xd forces = flow.step(packing.view(), dt).total;
    expect_sound(flow);
    pfv::Flow fresh(upward_box(pfv::Wall::no_slip), viscosity_one(), lenient());
    EXPECT_TRUE(forces == fresh.step(packing.view(), dt).total);
  }
  EXPECT_EQ(flow.report().counts.triangulate, 40);
}

TEST(ComingAndGoing, AcrossAFaceIsLeftOutAndTakenBack) {
  auto packing = random_packing(40, 0.05, 0.1, 3);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), lenient());
  const Eigen::Matrix3Xd inside = flow.step(packing.view(), dt).total;
  const Eigen::Vector3d home = packing.positions.col(7);
  for (int step = 0; step < 20; ++step) {
    packing.positions.col(7) = step % 2 ? home : Eigen::Vector3d(home[0], home[1], 1.0 + 1e-9);
    const Eigen::Matrix3Xd forces = flow.step(packing.view(), dt).total;
    expect_sound(flow);
    EXPECT_EQ(flow.hidden_or_outside(), step % 2 ? 0 : 1);
    if (step % 2)
      EXPECT_TRUE(forces == inside);
    else
      EXPECT_TRUE(forces.col(7).isZero(0.0));
  }
  // all of them outside, and back
  const Eigen::Matrix3Xd places = packing.positions;
  packing.positions.row(0).array() += 5.0;
  EXPECT_TRUE(flow.step(packing.view(), dt).total.isZero(0.0));
  packing.positions = places;
  EXPECT_TRUE(flow.step(packing.view(), dt).total == inside);
}

TEST(Jumps, OfTheWholePackingInOneStepAreTriangulatedAnew) {
  auto packing = random_packing(60, 0.05, 0.1, 3);
  const auto other = random_packing(60, 0.05, 0.1, 17);
  for (const bool compressible : {false, true}) {
    pfv::Fluid fluid = viscosity_one();
    if (compressible) fluid.bulk_modulus = 1e5;
    pfv::Flow flow(upward_box(pfv::Wall::no_slip), fluid);
    flow.step(packing.view(), dt);
    pfv::PackingArrays jumped = packing;
    jumped.positions = other.positions;
    jumped.velocities = (other.positions - packing.positions) / dt;
    const Eigen::Matrix3Xd forces = flow.step(jumped.view(), dt).total;
    expect_sound(flow);
    EXPECT_EQ(flow.report().counts.triangulate, 2);
    if (compressible) continue;  // the fluid remembers
    pfv::Flow fresh(upward_box(pfv::Wall::no_slip), fluid);
    EXPECT_TRUE(forces == fresh.step(jumped.view(), dt).total);
  }
}

// Radii that swell from touching nothing to overlapping deeply: the flow falls to that of round-off
// channels, and comes back with the radii.
TEST(Swelling, UntilTheBedIsClosedAndBack) {
  auto packing = random_packing(80, 0.08, 0.11, 5);
  const Eigen::VectorXd radii = packing.radii;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  double first = 0.0, last = 0.0, least = 1e300;
  for (int step = 0; step <= 40; ++step) {
    packing.radii = radii * (1.0 + 0.02 * std::min(step, 40 - step));
    flow.evaluate(packing.view());
    const double inflow = flow.report().inflow;
    EXPECT_LT(flow.report().force_balance_error, 1e-13);
    record_balances(flow.report());
    if (step == 0) first = inflow;
    last = inflow;
    least = std::min(least, inflow);
  }
  EXPECT_LT(least, 0.1 * first);
  EXPECT_EQ(last, first);
}

}  // namespace
}  // namespace moving_grains_test
