// SPDX-License-Identifier: GPL-3.0-or-later
// Mass and force balances on every packing of tests/data. The paper promises 1e-6 for the fluxes
// and 1e-7 for the forces; a direct solver and exact geometry at the walls give round-off.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <ostream>

namespace balances_test {
namespace {

using namespace support;

struct Case {
  std::string packing;
  pfv::Wall wall;
  double common_pressure;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.packing << (c.wall == pfv::Wall::symmetry ? " symmetry" : " no_slip") << " + "
             << c.common_pressure << " Pa";
}

/// Viscous forces on all faces and pressure forces on those without a pressure, with the spheres'.
Eigen::Vector3d force_on_solid(const pfv::Report& report, const pfv::Box& box) {
  Eigen::Vector3d sum = report.force_sum;
  for (const pfv::Face face : pfv::all_faces) {
    const pfv::FaceResult& result = report.faces[static_cast<int>(face)];
    sum += result.force_viscous;
    if (!box[face].boundary.is_open()) sum += result.force_pressure;
  }
  return sum;
}

class Balances : public testing::TestWithParam<Case> {
 protected:
  const double p_ = GetParam().common_pressure;
  const pfv::PackingArrays packing_ = data_packing(GetParam().packing);
};

TEST_P(Balances, StillGrains) {
  const pfv::Box box = pressure_box(pfv::Face::zlo, p_ + 1.0, pfv::Face::zhi, p_, GetParam().wall);
  pfv::Flow flow(box, viscosity_one(), hydraulic_radius());
  flow.evaluate(packing_.view());
  const pfv::Report report = flow.report();
  // with conductances up to 1e7 times the smallest one: measured at most 5.4e-16
  EXPECT_LT(std::abs(report.mass_error), 2e-15);
  EXPECT_LT(report.force_balance_error, 1e-14);  // measured at most 8e-16
  EXPECT_LT(report.residual, 3e-13);  // measured at most 1.3e-13
  EXPECT_EQ(report.volume_rate_sum, 0.0);
  // p + 1 itself is rounded to 1.5e-11 at 1e5 Pa, and so are the face forces p S
  const double rounding = 1e-13 + 1e-15 * p_;
  EXPECT_LT((force_on_solid(report, box) - Eigen::Vector3d(0, 0, 1)).norm(), rounding);
}

TEST_P(Balances, PistonDrainedThroughItself) {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].wall = GetParam().wall;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(p_);
  box[pfv::Face::zhi].velocity = -1.0;
  pfv::PackingArrays packing = packing_;
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
  packing.velocities.row(2) = -packing.positions.row(2);
  pfv::Flow flow(box, viscosity_one(), hydraulic_radius());
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  EXPECT_NEAR(report.volume_rate_sum, -1.0, 1e-12);
  EXPECT_NEAR(report.outflow, 1.0, 1e-12);
  EXPECT_EQ(report.inflow, 0.0);
  EXPECT_LT(std::abs(report.mass_error), 2e-15);  // measured at most 3.4e-16
  EXPECT_LT(report.force_balance_error, 1e-14);
  EXPECT_FALSE(report.permeability.has_value());
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* name : {"packing_100.csv", "packing_500.csv", "packing_36_near_touching.csv",
                           "packing_36_loose.csv"})
    for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry})
      for (const double common : {0.0, 1e5}) cases.push_back({name, wall, common});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Packings, Balances, testing::ValuesIn(all_cases()));

TEST(CommonPressure, ChangesNoFlowAndNoForceOnASphere) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  const auto solve = [&](double common) {
    pfv::Flow flow(pressure_box(pfv::Face::zlo, common + 1.0, pfv::Face::zhi, common,
                                pfv::Wall::no_slip),
                   viscosity_one(), hydraulic_radius());
    const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
    return std::make_pair(forces, *flow.report().permeability);
  };
  const auto [low_forces, low] = solve(0.0);
  const auto [high_forces, high] = solve(131072.0);  // a power of two: p + 1 is exact
  EXPECT_NEAR(high / low, 1.0, 1e-13);
  EXPECT_LT((high_forces - low_forces).norm(), 1e-13 * low_forces.norm());
}

}  // namespace
}  // namespace balances_test
