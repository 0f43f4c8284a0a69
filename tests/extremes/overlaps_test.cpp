// SPDX-License-Identifier: GPL-3.0-or-later
// Overlaps of 1 % to 99 %, spheres across faces, edges and corners, centres a hair from a face.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace overlaps_test {
namespace {

using namespace support;

pfv::Report solve(const pfv::PackingArrays& packing) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  const pfv::Forces& forces = flow.evaluate(packing.view());
  EXPECT_TRUE(forces.total.allFinite());
  EXPECT_TRUE(flow.pore_pressures().allFinite());
  // no pressure leaves the range of the imposed ones
  EXPECT_GE(flow.pore_pressures().minCoeff(), -1e-9);
  EXPECT_LE(flow.pore_pressures().maxCoeff(), 1.0 + 1e-9);
  const pfv::Report report = flow.report();
  record_balances(report);
  EXPECT_LT(std::abs(report.mass_error), 2e-15);
  EXPECT_LT(report.force_balance_error, 1e-13);
  EXPECT_GT(report.porosity, 0.0);
  EXPECT_LT(report.porosity, 1.0);
  return report;
}

class Overlaps : public testing::TestWithParam<double> {};

TEST_P(Overlaps, OfAWholeBedBalance) {
  auto packing = random_packing(150, 0.05, 0.08, 14);
  packing.radii *= 1.0 + GetParam();
  solve(packing);
}

TEST_P(Overlaps, OfPairsBalance) {
  auto single = random_packing(60, 0.04, 0.06, 15);
  std::vector<Sphere> pairs;
  Random random(16);
  for (int k = 0; k < 60; ++k) {
    const double r = 0.9 * single.radii[k];
    const Eigen::Vector3d x = single.positions.col(k);
    const Eigen::Vector3d y = x + 2.0 * r * (1.0 - GetParam()) * random.in_cube().normalized();
    pairs.push_back({x[0], x[1], x[2], r});
    if ((y.array() > 0.0).all() && (y.array() < 1.0).all())
      pairs.push_back({y[0], y[1], y[2], 0.97 * r});
  }
  solve(packing_of(pairs));
}

INSTANTIATE_TEST_SUITE_P(Depths, Overlaps, testing::Values(0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99));

TEST(CrossedFaces, ByUpToHalfARadiusBalance) {
  for (const double depth : {0.1, 0.3, 0.5}) {
    auto packing = random_packing(100, 0.06, 0.1, 18);
    std::vector<Sphere> spheres;
    for (int k = 0; k < packing.radii.size(); ++k)
      spheres.push_back({packing.positions(0, k), packing.positions(1, k),
                         packing.positions(2, k), packing.radii[k]});
    const double r = 0.15, a = (1.0 - depth) * r;
    spheres.push_back({a, 0.5, 0.5, r});          // a face
    spheres.push_back({1.0 - a, 0.45, 1.0 - a, r});  // an edge
    spheres.push_back({a, a, 1.0 - a, r});        // a corner
    solve(packing_of(spheres));
  }
}

TEST(CrossedFaces, CentresAHairFromFacesEdgesAndCornersBalance) {
  for (const double hair : {1e-3, 1e-9, 1e-15}) {
    auto packing = random_packing(100, 0.06, 0.1, 18);
    packing.positions(0, 40) = hair;
    packing.positions(1, 50) = 1.0 - hair;
    packing.positions(2, 60) = hair;
    packing.positions.col(70).setConstant(hair);
    packing.positions.col(71) << hair, 1.0 - hair, 0.5;
    solve(packing);
  }
}

TEST(Extremes, SameInputSameBytes) {
  auto packing = random_packing(150, 0.05, 0.08, 14);
  packing.radii *= 1.5;
  const auto run = [&] {
    pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
    return Eigen::Matrix3Xd(flow.evaluate(packing.view()).total);
  };
  EXPECT_TRUE(run() == run());
}

}  // namespace
}  // namespace overlaps_test
