// SPDX-License-Identifier: GPL-3.0-or-later
// Limit of the explicit coupling: dt < 2 / lambda_max(M^-1 S G^-1 S^T).
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <limits>

namespace time_step_limit_test {
namespace {

using namespace support;

constexpr double infinite = std::numeric_limits<double>::infinity();

pfv::Options with_torques() {
  pfv::Options options;
  options.torques = true;
  return options;
}

struct Sample {
  pfv::PackingArrays packing = data_packing("packing_100.csv");
  Eigen::VectorXd masses = 2600.0 * 4.0 / 3.0 * pi * packing.radii.array().cube();
  pfv::Flow flow{pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::symmetry),
                 viscosity_one(), with_torques()};

  Eigen::VectorXd inertias = 0.4 * masses.array() * packing.radii.array().square();

  const pfv::Forces& forces(const Eigen::Matrix3Xd& velocities, const Eigen::Matrix3Xd& spins) {
    packing.velocities = velocities;
    packing.angular_velocities = spins;
    return flow.evaluate(packing.view());
  }
  Eigen::Matrix3Xd zeros() const { return Eigen::Matrix3Xd::Zero(3, masses.size()); }
  const pfv::Forces& at_rest() { return forces(zeros(), zeros()); }
};

/// Speed after 2000 explicit steps of m dv/dt = F(v), over that at the start.
double growth(Sample& sample, double dt) {
  Random random(1);
  Eigen::Matrix3Xd v(3, sample.masses.size());
  for (int k = 0; k < v.cols(); ++k) v.col(k) = random.in_cube();
  Eigen::Matrix3Xd spin = sample.zeros();
  const double start = v.norm();
  for (int step = 0; step < 2000 && v.norm() < 1e6 * start; ++step) {
    const pfv::Forces& f = sample.forces(v, spin);
    for (int k = 0; k < v.cols(); ++k) {
      v.col(k) += dt / sample.masses[k] * f.total.col(k);
      spin.col(k) += dt / sample.inertias[k] * f.torque.col(k);
    }
  }
  return v.norm() / start;
}

TEST(TimeStepLimit, SeparatesDecayFromGrowth) {
  Sample sample;
  sample.at_rest();
  const double limit = sample.flow.time_step_limit(sample.masses);
  EXPECT_LT(growth(sample, 0.95 * limit), 1.0);
  EXPECT_GT(growth(sample, 1.2 * limit), 1e5);
}

// The whole operator, column by column, and its eigenvalues.
TEST(TimeStepLimit, IsThatOfTheOperatorsLargestEigenvalueFromBelow) {
  Sample sample;
  const auto n = static_cast<int>(sample.masses.size());
  Eigen::MatrixXd drag(6 * n, 6 * n);
  for (int c = 0; c < 6 * n; ++c) {
    Eigen::Matrix3Xd motion[2] = {sample.zeros(), sample.zeros()};
    motion[c / (3 * n)](c % 3, c / 3 % n) = 1.0;
    const pfv::Forces& f = sample.forces(motion[0], motion[1]);
    for (int k = 0; k < n; ++k) {
      drag.block<3, 1>(3 * k, c) = -f.total.col(k) / sample.masses[k];
      drag.block<3, 1>(3 * (n + k), c) = -f.torque.col(k) / sample.inertias[k];
    }
  }
  const double largest = drag.eigenvalues().cwiseAbs().maxCoeff();
  const double limit = sample.flow.time_step_limit(sample.masses);
  EXPECT_LT(limit * largest / 2.0, 1.0);
  EXPECT_GT(limit * largest / 2.0, 0.9);
}

TEST(StiffestGrain, BoundsTheLimitFromAboveInADensePacking) {
  Sample sample;
  sample.at_rest();
  const double limit = sample.flow.time_step_limit(sample.masses);
  const pfv::StiffestGrain stiffest = sample.flow.stiffest_grain(sample.masses);
  EXPECT_GE(stiffest.limit, limit);
  EXPECT_LT(stiffest.limit, 14.0 * limit);  // which has the spins in it
  EXPECT_NEAR(sample.flow.stiffest_grain(4.0 * sample.masses).limit / stiffest.limit, 4.0, 1e-12);
  EXPECT_EQ(sample.flow.stiffest_grain(Eigen::VectorXd::Constant(sample.masses.size(), infinite)).limit, infinite);
  expect_line(refusal([&] { sample.flow.stiffest_grain(Eigen::VectorXd::Ones(3)); }), "3 masses for 100 spheres");
}

// Three spheres that overlap, held, and a free one that shuts the hollow between them as it comes down.
TEST(StiffestGrain, IsTheLimitItselfWhereAPoreNearlyCloses) {
  const double side = 0.3, radius = 0.2;
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(4, infinite);
  masses[3] = 1.0;
  double before = infinite, above = infinite;
  for (const double height : {0.37, 0.355, 0.34, 0.335}) {
    pfv::PackingArrays packing;
    packing.ids = pfv::Packing::Ids::LinSpaced(4, 11, 14);
    packing.radii = Eigen::VectorXd::Constant(4, radius);
    packing.positions.resize(3, 4);
    const double across = side / std::sqrt(3.0);
    packing.positions.row(0) << 0.5 + across, 0.5 - 0.5 * across, 0.5 - 0.5 * across, 0.5;
    packing.positions.row(1) << 0.5, 0.5 + 0.5 * side, 0.5 - 0.5 * side, 0.5;
    packing.positions.row(2) << 0.3, 0.3, 0.3, 0.3 + height;
    packing.velocities = Eigen::Matrix3Xd::Zero(3, 4);
    packing.velocities(2, 3) = -1.0;
    pfv::Flow flow(pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::symmetry), viscosity_one());
    flow.evaluate(packing.view(), 1.0);
    const double limit = flow.time_step_limit(masses);
    const pfv::StiffestGrain stiffest = flow.stiffest_grain(masses);
    EXPECT_EQ(stiffest.id, 14);
    EXPECT_GE(stiffest.limit, limit);
    EXPECT_LT(limit, 0.6 * before);
    before = limit;
    above = stiffest.limit / limit;
  }
  EXPECT_LT(above, 1.1);
}

TEST(TimeStepLimit, GoesWithTheMassesAndWithOneOverTheViscosity) {
  Sample sample;
  sample.at_rest();
  const double limit = sample.flow.time_step_limit(sample.masses);
  EXPECT_EQ(sample.flow.time_step_limit(sample.masses), limit);
  EXPECT_NEAR(sample.flow.time_step_limit(4.0 * sample.masses) / limit, 4.0, 1e-12);
  pfv::Fluid thick = viscosity_one();
  thick.viscosity = 8.0;
  pfv::Flow flow(sample.flow.container(), thick, with_torques());
  flow.evaluate(sample.packing.view());
  EXPECT_NEAR(flow.time_step_limit(sample.masses) * 8.0 / limit, 1.0, 1e-12);
}

TEST(TimeStepLimit, IsInfiniteWhereNothingIsUnknown) {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].boundary = pfv::Boundary::pressure(0.0);
  pfv::Options without;
  without.open_water = false;
  pfv::Flow flow(box, viscosity_one(), without);
  const auto packing = packing_of({{0.5, 0.5, 0.5, 0.2}});
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.time_step_limit(Eigen::VectorXd::Ones(1)),
            std::numeric_limits<double>::infinity());
}

TEST(TimeStepLimit, LeavesTheResultsOfTheLastCallAlone) {
  Sample sample;
  const Eigen::Matrix3Xd before = sample.forces(-sample.packing.positions, sample.zeros()).total;
  sample.flow.time_step_limit(sample.masses);
  EXPECT_TRUE(sample.flow.forces().total == before);
  EXPECT_EQ(sample.flow.report().mass_error, sample.flow.report().mass_error);
}

}  // namespace
}  // namespace time_step_limit_test
