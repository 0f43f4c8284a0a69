// SPDX-License-Identifier: GPL-3.0-or-later
// Fine spheres that float in a pore, spheres hidden in others.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace small_spheres_test {
namespace {

using namespace support;

std::vector<Sphere> bed() {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  std::vector<Sphere> spheres;
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k)
    spheres.push_back({packing.positions(0, k), packing.positions(1, k), packing.positions(2, k),
                       packing.radii[k]});
  return spheres;
}

/// Distance from a place to the next surface of sphere or wall.
double gap(const std::vector<Sphere>& spheres, const Eigen::Vector3d& place) {
  double least = std::min(place.minCoeff(), 1.0 - place.maxCoeff());
  for (const Sphere& s : spheres)
    least = std::min(least, (place - Eigen::Vector3d(s.x, s.y, s.z)).norm() - s.radius);
  return least;
}

struct Solved {
  Eigen::Matrix3Xd forces;
  pfv::Report report;
};

Solved solve(const std::vector<Sphere>& spheres) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  Solved solved{flow.evaluate(packing_of(spheres).view()).total, flow.report()};
  record_balances(solved.report);
  EXPECT_TRUE(solved.forces.allFinite());
  EXPECT_LT(std::abs(solved.report.mass_error), 1e-13);
  EXPECT_LT(solved.report.force_balance_error, 1e-14);
  return solved;
}

TEST(FineSphere, FloatingInAPoreChangesNothingAndTakesTheForceOfItsSize) {
  const std::vector<Sphere> alone = bed();
  const Solved without = solve(alone);
  Eigen::Vector3d widest = Eigen::Vector3d::Constant(0.5);
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d place = random.in_cube(0.0, 1.0);
    if (gap(alone, place) > gap(alone, widest)) widest = place;
  }
  double last = without.forces.colwise().norm().mean();
  for (const double share : {0.1, 1e-2, 1e-3, 1e-5}) {
    std::vector<Sphere> spheres = alone;
    const double radius = share * gap(alone, widest);
    spheres.push_back({widest[0], widest[1], widest[2], radius});
    const Solved with = solve(spheres);
    EXPECT_EQ(with.report.hidden, 0);
    const double force = with.forces.rightCols(1).norm();
    EXPECT_GT(force, 0.0);
    EXPECT_LT(force, last);
    last = force;
    // a pore with its centre elsewhere conducts otherwise: 5 % of the permeability for a large share
    EXPECT_NEAR(*with.report.permeability / *without.report.permeability, 1.0, 0.05);
  }
}

TEST(HiddenSpheres, InAChainOfThemChangeNothing) {
  const std::vector<Sphere> alone = bed();
  const Solved without = solve(alone);
  std::vector<Sphere> spheres = alone;
  Sphere host = alone[40];
  constexpr int links = 6;
  for (int i = 0; i < links; ++i) {  // each in the last, off its middle
    const double inner = 0.6 * host.radius, off = 0.3 * (host.radius - inner);
    host = {host.x + 0.6 * off, host.y, host.z - 0.8 * off, inner};
    spheres.push_back(host);
  }
  const Solved with = solve(spheres);
  EXPECT_EQ(with.report.hidden, links);
  const Eigen::Index n = without.forces.cols();
  EXPECT_TRUE(with.forces.rightCols(links).isZero(0.0));
  EXPECT_LT((with.forces.leftCols(n) - without.forces).norm(), 1e-13 * without.forces.norm());
  EXPECT_NEAR(with.report.pore_volume / without.report.pore_volume, 1.0, 1e-13);
}

}  // namespace
}  // namespace small_spheres_test
