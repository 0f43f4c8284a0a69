// SPDX-License-Identifier: GPL-3.0-or-later
// Stresses of single grains: of their contacts, of their motion, and as files have them.
#include "pfv/grain_stresses.hpp"

#include "pfv/error.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

namespace pfv {
namespace grain_stresses_test {
namespace {

using namespace support;
using Rows = Eigen::Matrix<double, 6, 1>;

Rows symmetric_part(const Eigen::Matrix3d& tensor) {
  const Eigen::Matrix3d s = 0.5 * (tensor + tensor.transpose());
  Rows rows;
  rows << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2);
  return rows;
}

double volume_of(double radius) { return 4.0 / 3.0 * M_PI * std::pow(radius, 3); }

struct OneContact {
  int sphere;
  Eigen::Vector3d point, force;
};

ContactForces together(const std::vector<OneContact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  ContactForces all{decltype(all.spheres)(count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index c = 0; c < count; ++c) {
    all.spheres[c] = contacts[c].sphere;
    all.points.col(c) = contacts[c].point;
    all.forces.col(c) = contacts[c].force;
  }
  return all;
}

/// A stress that is the same everywhere, on lattices of cubes: each contact carries that of its cell's face. The
/// grains' stress times their share of the room is that stress (eq. 2.19).
TEST(GrainStresses, OfAnEvenStressAreItOverTheSolidFraction) {
  Eigen::Matrix3d stress;
  stress << -3.0, 0.4, -0.2, 0.4, -5.0, 0.7, -0.2, 0.7, -1.0;
  const double radius = 0.2, edge = 2.0 * radius, solid = M_PI / 6.0;
  PackingArrays packing;
  packing.ids = Packing::Ids::LinSpaced(8, 1, 8);
  packing.radii = Eigen::VectorXd::Constant(8, radius);
  packing.positions.resize(3, 8);
  std::vector<OneContact> contacts;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d centre =
        edge * Eigen::Vector3d(k & 1, (k >> 1) & 1, k >> 2) + Eigen::Vector3d(7.0, -3.0, 0.1);
    packing.positions.col(k) = centre;
    for (const double side : {-1.0, 1.0})
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
        contacts.push_back({k, centre + radius * normal, edge * edge * stress * normal});
      }
  }
  const SphereTensors found = contact_stresses(packing.view(), together(contacts));
  EXPECT_LT(((solid * found).colwise() - symmetric_part(stress)).cwiseAbs().maxCoeff(), 1e-12);
}

/// All spheres at hand, pushed by their neighbours and by walls at random: what they have in sum is the moment of the
/// walls' forces, less that of the resultants, which accelerate them.
TEST(GrainStresses, AddUpToTheMomentOfTheWallsForces) {
  const PackingArrays packing = data_packing("packing_500.csv");
  Random random(11);
  std::vector<OneContact> contacts;
  Eigen::Matrix3d of_walls = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd resultants = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  const auto push = [&](int k, const Eigen::Vector3d& point, const Eigen::Vector3d& force) {
    contacts.push_back({k, point, force});
    resultants.col(k) += force;
  };
  for (int i = 0; i < packing.radii.size(); ++i) {
    const Eigen::Vector3d here = packing.positions.col(i);
    for (int j = i + 1; j < packing.radii.size(); ++j) {
      const Eigen::Vector3d way = packing.positions.col(j) - here;
      if (way.norm() > packing.radii[i] + packing.radii[j]) continue;
      const Eigen::Vector3d force = random.in_cube(-2.0, 2.0), point = here + packing.radii[i] / way.norm() * way;
      push(i, point, force);
      push(j, point, -force);
    }
    if (here.z() > packing.radii[i]) continue;
    const Eigen::Vector3d force = random.in_cube(-2.0, 2.0), point(here.x(), here.y(), 0.0);
    push(i, point, force);
    of_walls += point * force.transpose();
  }
  ASSERT_GT(contacts.size(), 1000u);
  const Eigen::Matrix3d of_resultants = packing.positions * resultants.transpose();
  const SphereTensors stresses = contact_stresses(packing.view(), together(contacts));
  Rows sum = Rows::Zero();
  for (int i = 0; i < packing.radii.size(); ++i) sum += volume_of(packing.radii[i]) * stresses.col(i);
  const Rows expected = symmetric_part(of_walls - of_resultants);
  EXPECT_LT((sum - expected).norm(), 1e-12 * expected.norm());
}

/// v = G x in a lattice without a mean velocity.
TEST(GrainStresses, OfAnAffineMotionAreItsMomentumFlux) {
  PackingArrays packing = data_packing("packing_500.csv");
  Eigen::Matrix3d gradient;
  gradient << -0.1, 0.04, 0.0, -0.02, 0.05, 0.03, 0.06, 0.0, -0.2;
  packing.velocities = gradient * packing.positions;
  const double density = 2600.0;
  const Eigen::VectorXd masses = packing.radii.unaryExpr([&](double r) { return density * volume_of(r); });
  const Eigen::Vector3d centre = packing.positions * masses / masses.sum();
  const Eigen::Vector3d frame = mean_velocity(packing.view(), masses);
  EXPECT_LT((frame - gradient * centre).norm(), 1e-15);
  const SphereTensors stresses = inertial_stresses(packing.view(), masses, frame);
  for (int k = 0; k < packing.radii.size(); ++k) {
    const Eigen::Vector3d v = gradient * (packing.positions.col(k) - centre);
    EXPECT_LT((stresses.col(k) + density * symmetric_part(v * v.transpose())).norm(), 1e-12);
  }
}

TEST(GrainStresses, OfATriaxialStateHaveTheDifferenceOfItsStressesAsDeviator) {
  SphereTensors stresses(6, 2);
  stresses << -1.0, 0.0, -1.0, 0.0, -4.0, 0.0, 0.0, 0.5, 0.0, -0.25, 0.0, 2.0;
  const std::vector<Field> fields = stress_fields("contact_stress", stresses);
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[1].name, "contact_stress_deviator");
  EXPECT_NEAR(fields[1].values(0, 0), 3.0, 1e-15);
  EXPECT_NEAR(fields[1].values(0, 1), std::sqrt(3.0 * (0.25 + 0.0625 + 4.0)), 1e-15);
  EXPECT_EQ(fields[0].values(4, 1), 2.0);  // yz stands before xz
  EXPECT_EQ(fields[0].values(5, 1), -0.25);
}

TEST(GrainStresses, RefuseWhatDoesNotGoTogether) {
  const PackingArrays packing = data_packing("packing_100.csv");
  ContactForces contacts = together({{0, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}});
  contacts.spheres[0] = 100;
  EXPECT_THROW(contact_stresses(packing.view(), contacts), InputError);
  contacts.spheres[0] = 0;
  contacts.forces(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(contact_stresses(packing.view(), contacts), InputError);
  contacts.forces.resize(3, 0);
  EXPECT_THROW(contact_stresses(packing.view(), contacts), InputError);
  EXPECT_THROW(inertial_stresses(packing.view(), Eigen::VectorXd::Ones(99), Eigen::Vector3d::Zero()), InputError);
  EXPECT_EQ(contact_stresses(packing.view(), together({})), SphereTensors::Zero(6, 100));
}

}  // namespace
}  // namespace grain_stresses_test
}  // namespace pfv
