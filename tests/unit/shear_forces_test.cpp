// SPDX-License-Identifier: GPL-3.0-or-later
// Shear viscous forces: pairs, balance, dissipation, and their part in a step.
#include "network/pore_network.hpp"
#include "pfv/pfv.hpp"
#include "physics/shear_forces.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

namespace shear_forces_test {
namespace {

using namespace support;

pfv::PackingArrays moving_packing() {
  pfv::PackingArrays packing = data_packing("packing_500.csv");
  Random random(3);
  packing.velocities.resize(3, packing.positions.cols());
  for (Eigen::Index k = 0; k < packing.positions.cols(); ++k)
    packing.velocities.col(k) = random.in_cube();
  return packing;
}

pfv::Flow drained(bool shear, double viscosity = 1.0) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Fluid fluid;
  fluid.viscosity = viscosity;
  pfv::Options options;
  options.shear_viscous = shear;
  return pfv::Flow(box, fluid, options);
}

Eigen::Matrix3Xd shear_part(const pfv::PackingArrays& packing, double viscosity = 1.0) {
  pfv::Flow with = drained(true, viscosity), without = drained(false, viscosity);
  return with.step(packing.view(), 1e-3).total - without.step(packing.view(), 1e-3).total;
}

TEST(ShearForces, BalanceAndDissipate) {
  const auto packing = moving_packing();
  const Eigen::Matrix3Xd forces = shear_part(packing);
  const double scale = forces.colwise().norm().maxCoeff();
  EXPECT_GT(scale, 0.0);
  EXPECT_LT(forces.rowwise().sum().norm(), 1e-10 * scale * static_cast<double>(forces.cols()));
  EXPECT_LT(forces.cwiseProduct(packing.velocities).sum(), 0.0);
}

TEST(ShearForces, GoWithTheViscosity) {
  const auto packing = moving_packing();
  const Eigen::Matrix3Xd once = shear_part(packing), thrice = shear_part(packing, 3.0);
  EXPECT_LT((thrice - 3.0 * once).norm(), 1e-9 * thrice.norm());
}

TEST(ShearForces, VanishForARigidMotion) {
  auto packing = moving_packing();
  packing.velocities.colwise() = Eigen::Vector3d(0.3, -0.2, 0.0);
  const Eigen::Matrix3Xd total = drained(true).step(packing.view(), 1e-3).total;
  EXPECT_LT(shear_part(packing).norm(), 1e-12 * total.norm());
}

// On a simple cubic lattice of spacing a, neighbours share a square of a², and no others share any.
TEST(ShearForces, PairsOfALatticeShareSquares) {
  const int n = 4;
  const Stages stages = stages_of(lattice(Lattice::sc, n), upward_box(pfv::Wall::symmetry));
  const auto pairs = pfv::shear_pairs(stages.network, stages.throats, stages.spheres, stages.spheres);
  double largest = 0.0;
  int whole = 0;
  for (const pfv::ShearPair& pair : pairs) {
    largest = std::max(largest, pair.area);
    whole += pair.area > 0.999 / (n * n);
    EXPECT_TRUE(pair.area < 1e-6 || std::abs(pair.area * n * n - 1.0) < 1e-6) << pair.area;
  }
  EXPECT_NEAR(largest * n * n, 1.0, 1e-9);
  EXPECT_EQ(whole, 3 * n * n * (n - 1));
}

TEST(ShearForces, LowerTheTimeStepLimit) {
  const auto packing = moving_packing();
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(packing.positions.cols());
  pfv::Flow with = drained(true), without = drained(false);
  with.evaluate(packing.view());
  without.evaluate(packing.view());
  EXPECT_LT(with.time_step_limit(masses), without.time_step_limit(masses));
}

TEST(ShearForces, NeedForces) {
  pfv::Options options;
  options.shear_viscous = true;
  options.forces = false;
  expect_line(refusal([&] { pfv::check(options); }), "need forces");
}

}  // namespace
}  // namespace shear_forces_test
