// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness of the contacts around a sphere and the time step that they allow (Catalano 2012 eq. 2.14).
#include "pfv/error.hpp"
#include "pfv/time_step.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace contact_springs_test {
namespace {

using namespace support;

constexpr pfv::ContactStiffness springs{1000.0, 300.0};

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

TEST(ContactSprings, ResistAlongAndAcrossTheLineOfCentres) {
  const auto packing = packing_of({{0.4, 0.5, 0.5, 0.11}, {0.6, 0.5, 0.5, 0.1}});
  const pfv::ContactSprings contacts(packing.view(), pfv::Box{}, springs);
  for (const Eigen::Matrix3d& k : contacts.of_spheres())
    EXPECT_LT((k - diagonal(1000, 300, 300)).norm(), 1e-10);
  EXPECT_NEAR(pfv::contact_time_step(0.1, contacts.of_spheres()[0]), std::sqrt(0.1 / 1000.0), 1e-15);
  // omega² = k (1/m + 1/M); the iteration comes from below and is raised by 3 %
  const Eigen::Vector2d masses(0.1, 0.3);
  const double exact = 2.0 / std::sqrt(1000.0 * (1.0 / 0.1 + 1.0 / 0.3));
  const double ratio = contacts.time_step_limit(masses) / exact;
  EXPECT_GT(ratio, 1.0 / std::sqrt(1.03) - 1e-9);
  EXPECT_LT(ratio, 1.0);
}

TEST(ContactSprings, StandOnWallsButNotOnPeriodicFaces) {
  const auto packing = packing_of({{0.5, 0.5, 0.09, 0.1}});
  pfv::Box box;
  const auto on_wall = pfv::ContactSprings(packing.view(), box, springs);
  EXPECT_LT((on_wall.of_spheres()[0] - diagonal(300, 300, 1000)).norm(), 1e-10);
  box.periodic[2] = true;
  const auto alone = pfv::ContactSprings(packing.view(), box, springs);
  EXPECT_EQ(alone.of_spheres()[0].norm(), 0.0);
  EXPECT_EQ(alone.time_step_limit(Eigen::VectorXd::Ones(1)),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(pfv::contact_time_step(1.0, alone.of_spheres()[0]),
            std::numeric_limits<double>::infinity());
}

// Against all pairs and all 27 images.
TEST(ContactSprings, AreFoundAcrossPeriodicSides) {
  Random random(3);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 120; ++k) spheres.push_back({random(), random(), random(), random(0.03, 0.1)});
  const auto packing = packing_of(spheres);
  for (const int kinds : {0, 1, 6, 7}) {
    pfv::Box box;
    for (int axis = 0; axis < 3; ++axis) box.periodic[axis] = kinds >> axis & 1;
    std::vector<Eigen::Matrix3d> expected(spheres.size(), Eigen::Matrix3d::Zero());
    const auto add = [&](int k, const Eigen::Vector3d& n) {
      expected[k] += 300.0 * Eigen::Matrix3d::Identity() + 700.0 * n * n.transpose();
    };
    for (int a = 0; a < 120; ++a) {
      for (int axis = 0; axis < 3; ++axis)
        for (const double face : {0.0, 1.0})
          if (!box.periodic[axis] && std::abs(packing.positions(axis, a) - face) < packing.radii[a])
            add(a, Eigen::Vector3d::Unit(axis));
      for (int b = 0; b < 120; ++b)
        for (int image = 0; image < 27; ++image) {
          const Eigen::Vector3i shift(image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1);
          bool there = a != b;
          for (int axis = 0; axis < 3; ++axis) there = there && (shift[axis] == 0 || box.periodic[axis]);
          const Eigen::Vector3d way =
              packing.positions.col(b) + shift.cast<double>() - packing.positions.col(a);
          if (there && way.norm() < packing.radii[a] + packing.radii[b]) add(a, way.normalized());
        }
    }
    const auto found = pfv::ContactSprings(packing.view(), box, springs).of_spheres();
    for (int k = 0; k < 120; ++k) EXPECT_LT((found[k] - expected[k]).norm(), 1e-9) << kinds << k;
  }
}

TEST(ContactSprings, RefuseWhatIsNoStiffnessAndNoMass) {
  const auto packing = packing_of({{0.5, 0.5, 0.5, 0.2}});
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const pfv::ContactStiffness wrong :
       {pfv::ContactStiffness{0.0, 0.0}, {-1.0, 0.0}, {none, 0.0}, {1.0, -1.0}, {1.0, none}})
    expect_line(refusal([&] { pfv::ContactSprings(packing.view(), pfv::Box{}, wrong); }),
                "contact stiffness");
  const pfv::ContactSprings contacts(packing.view(), pfv::Box{}, springs);
  expect_line(refusal([&] { contacts.time_step_limit(Eigen::VectorXd::Ones(2)); }), "masses");
  expect_line(refusal([&] { contacts.time_step_limit(Eigen::VectorXd::Zero(1)); }), "mass");
}

}  // namespace
}  // namespace contact_springs_test
