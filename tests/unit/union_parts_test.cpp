// SPDX-License-Identifier: GPL-3.0-or-later
// The volume that each sphere of a rigid body has of the union, against formulas.
#include "pfv/pfv.hpp"

#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <random>

namespace union_parts_test {
namespace {

using namespace support;

double ball(double r) { return 4.0 / 3.0 * pi * r * r * r; }
double cap(double r, double height) { return pi * height * height * (3.0 * r - height) / 3.0; }

struct Body {
  Eigen::Matrix3Xd centres;
  Eigen::VectorXd radii;
};
Body body_of(const std::vector<Sphere>& spheres) {
  const auto packing = packing_of(spheres);
  return {packing.positions, packing.radii};
}

TEST(UnionParts, OfSpheresApartAreWhole) {
  const Body body = body_of({{0, 0, 0, 1}, {5, 0, 0, 2}, {0, 9, 1, 0.5}});
  const Eigen::VectorXd parts = pfv::union_parts(body.centres, body.radii);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(parts[k] / ball(body.radii[k]), 1.0, 1e-14);
}

TEST(UnionParts, OfOneSphereAndOfNone) {
  const Body one = body_of({{3, 2, 1, 0.1}});
  EXPECT_NEAR(pfv::union_parts(one.centres, one.radii)[0] / ball(0.1), 1.0, 1e-14);
  EXPECT_EQ(pfv::union_parts(Eigen::Matrix3Xd(3, 0), Eigen::VectorXd(0)).size(), 0);
}

// The plane of their common circle parts two spheres.
TEST(UnionParts, OfAPairLoseTheirCaps) {
  const double r = 0.01, s = 0.007, d = 0.012;
  const double x = (d * d + r * r - s * s) / (2.0 * d);
  const Body body = body_of({{5.0, 0, 0, r}, {5.0 + d, 0, 0, s}});
  const Eigen::VectorXd parts = pfv::union_parts(body.centres, body.radii);
  EXPECT_NEAR(parts[0] / (ball(r) - cap(r, r - x)), 1.0, 1e-11);
  EXPECT_NEAR(parts[1] / (ball(s) - cap(s, s - d + x)), 1.0, 1e-11);
}

TEST(UnionParts, OfCoveredAndOfRepeatedSpheresAreNothing) {
  const Body body = body_of({{0, 0, 0, 1}, {0.2, 0, 0, 0.5}, {0, 0, 0, 1}, {0, 0, 0, 0.3}});
  const Eigen::VectorXd parts = pfv::union_parts(body.centres, body.radii);
  EXPECT_NEAR(parts[0] / ball(1.0), 1.0, 1e-14);
  EXPECT_EQ(parts.tail(3).cwiseAbs().maxCoeff(), 0.0);
}

TEST(UnionParts, RefuseWhatIsNoSphere) {
  Body body = body_of({{0, 0, 0, 1}, {1, 0, 0, 1}});
  body.radii[1] = 0.0;
  expect_line(refusal([&] { pfv::union_parts(body.centres, body.radii); }), "radius");
  body.radii.resize(1);
  expect_line(refusal([&] { pfv::union_parts(body.centres, body.radii); }), "2 centres and 1");
}

Body clump(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.5, 1.0);
  std::vector<Sphere> spheres;
  for (int k = 0; k < count; ++k)
    spheres.push_back({place(random), place(random), place(random), size(random)});
  return body_of(spheres);
}

TEST(DisplacedVolumes, KeepTheVolumeAndActAtTheCentreOfMass) {
  const Eigen::Vector3d centre(0.05, -0.1, 0.02);
  for (const int count : {4, 5, 9, 30}) {
    const Body body = clump(count, 11u + static_cast<unsigned>(count));
    const Eigen::VectorXd parts = pfv::union_parts(body.centres, body.radii);
    const Eigen::VectorXd shares = pfv::displaced_volumes(body.centres, body.radii, centre);
    EXPECT_NEAR(shares.sum() / parts.sum(), 1.0, 1e-14);
    const Eigen::Vector3d moment = (body.centres.colwise() - centre) * shares;
    EXPECT_LT(moment.norm(), 1e-13 * parts.sum());
  }
}

// What they cannot turn about they do not try to: a pair about its axis, three about their plane.
TEST(DisplacedVolumes, ShiftWithinWhatTheSpheresSpan) {
  const Body pair = body_of({{0, 0, 0, 1}, {1.2, 0, 0, 0.7}});
  const Eigen::VectorXd shares = pfv::displaced_volumes(pair.centres, pair.radii, {0.3, 0.01, 0});
  EXPECT_NEAR(shares.sum() / pfv::union_parts(pair.centres, pair.radii).sum(), 1.0, 1e-14);
  EXPECT_NEAR(shares[1] * 1.2 / shares.sum(), 0.3, 1e-13);
}

TEST(DisplacedVolumes, AreWhatTheLiftCounts) {
  const auto grains = packing_of({{0.45, 0.5, 0.5, 0.1}, {0.55, 0.5, 0.5, 0.1}});
  auto body = grains;
  body.displaced_volumes = pfv::union_parts(grains.positions, grains.radii);
  pfv::Fluid fluid = viscosity_one();
  fluid.gravity = {0.0, 0.0, -10.0};
  const auto lift = [&](pfv::FlowModel&& flow, const pfv::PackingArrays& packing) {
    return flow.evaluate(packing.view()).total.row(2).sum();
  };
  const pfv::Box box = pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::symmetry);
  const double whole = 2.0 * ball(0.1), part = whole - 2.0 * cap(0.1, 0.05);
  EXPECT_NEAR(lift(pfv::Flow(box, fluid), grains) / (1e4 * whole), 1.0, 1e-14);
  EXPECT_NEAR(lift(pfv::Flow(box, fluid), body) / (1e4 * part), 1.0, 1e-12);
  EXPECT_NEAR(lift(pfv::DarcyGrid(box, fluid, {}), body) / (1e4 * part), 1.0, 1e-12);
  body.displaced_volumes.conservativeResize(1);
  pfv::Flow flow(box, fluid);
  expect_line(refusal([&] { flow.evaluate(body.view()); }), "1 displaced volumes for 2 spheres");
}

}  // namespace
}  // namespace union_parts_test
