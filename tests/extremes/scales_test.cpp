// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths from nanometres to kilometres, boxes far from the origin, slender boxes, wide size
// ratios.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace scales_test {
namespace {

using namespace support;

struct Result {
  pfv::Report report;
  Eigen::Matrix3Xd forces;
};

Result solve(const pfv::PackingArrays& packing, const pfv::Box& box) {
  pfv::Flow flow(box, viscosity_one(), hydraulic_radius());
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  EXPECT_TRUE(forces.allFinite());
  record_balances(flow.report());
  return {flow.report(), forces};
}

void scale(pfv::PackingArrays& packing, pfv::Box& box, double factor) {
  packing.positions *= factor;
  packing.radii *= factor;
  box.lower *= factor;
  box.upper *= factor;
}

// Permeability goes with the square of the length, force with the square, both without rounding
// where the factor is a power of two.
TEST(Scales, PowersOfTwoScaleToTheLastBit) {
  auto packing = data_packing("packing_100.csv");
  pfv::Box box = upward_box(pfv::Wall::no_slip);
  const Result one = solve(packing, box);
  for (const double factor : {0x1p-30, 0x1p10}) {  // radii from 1e-10 m to 1e2 m
    auto scaled = packing;
    pfv::Box scaled_box = box;
    scale(scaled, scaled_box, factor);
    const Result r = solve(scaled, scaled_box);
    EXPECT_EQ(r.report.pores, one.report.pores);
    EXPECT_TRUE(r.forces == factor * factor * one.forces);
    EXPECT_NEAR(*r.report.permeability / (factor * factor) / *one.report.permeability, 1.0, 1e-14);
  }
}

TEST(Scales, RadiiFrom1em9To1e3ScaleToRoundOff) {
  const auto packing = data_packing("packing_100.csv");
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  const Result one = solve(packing, box);
  for (const double factor : {1e-8, 1e-3, 1e4}) {
    auto scaled = packing;
    pfv::Box scaled_box = box;
    scale(scaled, scaled_box, factor);
    const Result r = solve(scaled, scaled_box);
    // round-off of the coordinates in the shortest throats (L down to 1e-4): measured 1e-12
    EXPECT_NEAR(*r.report.permeability / (factor * factor) / *one.report.permeability, 1.0, 1e-11);
    EXPECT_LT((r.forces / (factor * factor) - one.forces).norm(), 1e-11 * one.forces.norm());
    EXPECT_NEAR(r.report.porosity, one.report.porosity, 1e-13);
  }
}

// At 1e6 box lengths the input coordinates hold only ten digits. With positions that are exact
// there, nothing is lost; those that are rounded differ by as much as rounding moves the spheres.
TEST(FarBoxes, LoseOnlyTheDigitsOfTheInput) {
  auto packing = data_packing("packing_100.csv");
  const Eigen::Vector3d shift(1048576.0, -1048576.0, 524288.0);
  // multiples of 2^-30 survive the shift
  packing.positions = (packing.positions * 0x1p30).array().round() * 0x1p-30;
  pfv::Box box = upward_box(pfv::Wall::no_slip);
  const Result near = solve(packing, box);
  auto far = packing;
  far.positions.colwise() += shift;
  box.lower += shift;
  box.upper += shift;
  const Result exact = solve(far, box);
  EXPECT_TRUE(exact.forces == near.forces);
  EXPECT_EQ(*exact.report.permeability, *near.report.permeability);
  EXPECT_EQ(exact.report.porosity, near.report.porosity);

  auto rounded = data_packing("packing_100.csv");
  const Result all_digits = solve(rounded, upward_box(pfv::Wall::no_slip));
  rounded.positions.colwise() += shift;
  const Result lost = solve(rounded, box);  // 1e-10 of the box; R_h² and 1/L amplify it
  EXPECT_NEAR(*lost.report.permeability / *all_digits.report.permeability, 1.0, 1e-8);
}

TEST(SlenderBoxes, OfAspect1000Balance) {
  for (const int axis : {0, 1, 2}) {
    pfv::Box box;
    box.upper[axis] = 1000.0;
    const auto packing = random_packing(2000, 0.15, 0.3, 8, box);
    box[static_cast<pfv::Face>(2 * axis)].boundary = pfv::Boundary::pressure(1.0);
    box[static_cast<pfv::Face>(2 * axis + 1)].boundary = pfv::Boundary::pressure(0.0);
    const Result r = solve(packing, box);
    EXPECT_NEAR(r.report.pore_volume / (1000.0 - solid_volume(packing)), 1.0, 1e-12);
    // the whole bed conducts 1e-3 of one of its throats, the shortest throats 1e6 of one: round-off
    // of p alone would be 1e-9 of the flow (measured 2.3e-15 at most)
    EXPECT_LT(std::abs(r.report.mass_error), 1e-14);
    EXPECT_LT(r.report.force_balance_error, 1e-13);
    EXPECT_GT(*r.report.permeability, 0.0);
  }
}

TEST(SlenderBoxes, OfAspect1000AcrossBalance) {
  pfv::Box box;  // a plate
  box.upper = {30.0, 30.0, 0.03};
  const auto packing = random_packing(300, 0.005, 0.014, 8, box);
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  const Result r = solve(packing, box);
  EXPECT_NEAR(r.report.pore_volume / (27.0 - solid_volume(packing)), 1.0, 1e-12);
  EXPECT_LT(std::abs(r.report.mass_error), 1e-14);
  EXPECT_LT(r.report.force_balance_error, 1e-13);
}

class SizeRatios : public testing::TestWithParam<double> {};

// Few large spheres and many small ones, in contact with nothing.
TEST_P(SizeRatios, KeepTheSumRulesAndBalances) {
  const double ratio = GetParam(), large = 0.2;
  std::vector<Sphere> spheres{{0.3, 0.3, 0.3, large}, {0.7, 0.7, 0.3, large},
                              {0.3, 0.7, 0.7, large}, {0.7, 0.3, 0.7, large}};
  Random random(3);
  while (spheres.size() < 300) {
    const double r = large / ratio;
    const Eigen::Vector3d x = random.in_cube(r, 1.0 - r);
    bool free = true;
    for (const Sphere& s : spheres)
      free = free && (x - Eigen::Vector3d(s.x, s.y, s.z)).norm() > r + s.radius;
    if (free) spheres.push_back({x[0], x[1], x[2], r});
  }
  const auto packing = packing_of(spheres);
  const Result r = solve(packing, upward_box(pfv::Wall::no_slip));
  EXPECT_EQ(r.report.hidden, 0);
  EXPECT_NEAR(r.report.pore_volume / (1.0 - solid_volume(packing)), 1.0, 1e-12);
  EXPECT_NEAR(r.report.solid_area / solid_surface(packing), 1.0, 1e-12);
  EXPECT_LT(std::abs(r.report.mass_error), 1e-14);
  EXPECT_LT(r.report.force_balance_error, 1e-13);
  EXPECT_GT(*r.report.permeability, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Ratios, SizeRatios, testing::Values(10.0, 100.0, 1e3, 1e4, 1e5));

}  // namespace
}  // namespace scales_test
