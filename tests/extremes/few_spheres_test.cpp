// SPDX-License-Identifier: GPL-3.0-or-later
// One to four spheres, and sets in a plane or on a line.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace few_spheres_test {
namespace {

using namespace support;

pfv::Report solve(const pfv::PackingArrays& packing, pfv::Wall wall = pfv::Wall::no_slip) {
  pfv::Flow flow(upward_box(wall), viscosity_one(), hydraulic_radius());
  const pfv::Forces& forces = flow.evaluate(packing.view());
  EXPECT_TRUE(forces.total.allFinite());
  const pfv::Report report = flow.report();
  record_balances(report);
  EXPECT_LT(std::abs(report.mass_error), 1e-12);
  EXPECT_LT(report.force_balance_error, 1e-14);
  EXPECT_NEAR(report.pore_volume, 1.0 - solid_volume(packing), 1e-13);
  return report;
}

TEST(FewSpheres, OneHasEightPoresAndTakesTheWholeForceBetweenSymmetryWalls) {
  const auto packing = packing_of({{0.4, 0.5, 0.6, 0.3}});
  const pfv::Report report = solve(packing, pfv::Wall::symmetry);
  EXPECT_EQ(report.pores, 8);
  EXPECT_EQ(report.unknowns, 0);
  EXPECT_NEAR(report.force_sum[2], 1.0, 1e-14);
  EXPECT_NEAR(report.force_sum[0], 0.0, 1e-15);
}

TEST(FewSpheres, TwoThreeAndFourBalance) {
  std::vector<Sphere> spheres{{0.3, 0.4, 0.25, 0.15}};
  for (const Sphere& next : {Sphere{0.6, 0.55, 0.7, 0.2}, Sphere{0.25, 0.75, 0.6, 0.1},
                             Sphere{0.7, 0.25, 0.35, 0.12}}) {
    spheres.push_back(next);
    const pfv::Report report = solve(packing_of(spheres));
    EXPECT_GT(*report.permeability, 0.0);
  }
}

TEST(FewSpheres, OnALineBalanceAlongEachAxisAndADiagonal) {
  for (const Eigen::Vector3d& way :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 1)}) {
    std::vector<Sphere> line;
    for (int i = -3; i <= 3; ++i) {
      const Eigen::Vector3d x = Eigen::Vector3d::Constant(0.5) + 0.13 * i * way;
      line.push_back({x[0], x[1], x[2], 0.05});
    }
    EXPECT_GT(*solve(packing_of(line)).permeability, 0.0);
  }
}

TEST(FewSpheres, InAPlaneBalanceStraightAndOblique) {
  for (const double tilt : {0.0, 0.3}) {
    std::vector<Sphere> plane;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        plane.push_back({0.1 + 0.2 * i, 0.1 + 0.2 * j, 0.5 + tilt * 0.2 * (i - 2), 0.08});
    EXPECT_GT(*solve(packing_of(plane)).permeability, 0.0);
  }
}

TEST(FewSpheres, NoneIsRefusedOrAnEmptyFlowWhereGrainsMayBeLeftOut) {
  const auto outside = packing_of({{1.5, 0.5, 0.5, 0.1}});
  pfv::Flow strict(upward_box(pfv::Wall::no_slip), viscosity_one(), hydraulic_radius());
  expect_line(refusal([&] { strict.evaluate(outside.view()); }), "sphere 1");
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  pfv::Flow lenient(upward_box(pfv::Wall::no_slip), viscosity_one(), options);
  EXPECT_TRUE(lenient.evaluate(outside.view()).total.isZero(0.0));
  EXPECT_EQ(lenient.report().outside, 1);
  EXPECT_EQ(lenient.report().porosity, 1.0);
}

TEST(FewSpheres, OnACubeMergeIntoOnePore) {
  // eight cospherical centres in an oblique cube
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Sphere> cube;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5);
    const Eigen::Vector3d x = Eigen::Vector3d::Constant(0.5) + 0.3 * (turn * corner);
    cube.push_back({x[0], x[1], x[2], 0.1});
  }
  EXPECT_GE(solve(packing_of(cube)).counts.merged_pores, 4);
}

TEST(FewSpheres, OneInABoxAMillionTimesAsWideTakesNoVisibleForce) {
  for (const double radius : {1e-2, 1e-4, 1e-6}) {
    const auto packing = packing_of({{0.4, 0.5, 0.6, radius}});
    const pfv::Report report = solve(packing);
    EXPECT_EQ(report.pores, 8);
    EXPECT_NEAR(report.solid_area / solid_surface(packing), 1.0, 1e-12);
  }
}

TEST(FewSpheres, OnExactLatticesBalance) {
  for (const Lattice kind : {Lattice::sc, Lattice::bcc, Lattice::fcc})
    for (const double scale : {1.0, 0.9, 1.05})
      for (const int cells : {1, 3}) {
        const pfv::PackingArrays packing = lattice(kind, cells, scale);
        pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
        EXPECT_TRUE(flow.evaluate(packing.view()).total.allFinite());
        const pfv::Report report = flow.report();
        record_balances(report);
        EXPECT_LT(std::abs(report.mass_error), 1e-14);
        EXPECT_LT(report.force_balance_error, 1e-14);
      }
}

}  // namespace
}  // namespace few_spheres_test
