// SPDX-License-Identifier: GPL-3.0-or-later
// The strain around each sphere, from the displacements of its neighbours.
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace pfv {
namespace sphere_strains_test {
namespace {

using namespace support;
using Strain = Eigen::Matrix<double, 6, 1>;

Flow flow_through(const PackingArrays& packing, const Box& box) {
  Flow flow(box, viscosity_one(), {});
  flow.evaluate(packing.view());
  return flow;
}

/// Large, without symmetry.
Eigen::Matrix3d stretch() {
  Eigen::Matrix3d gradient;
  gradient << -0.1, 0.04, 0.0, -0.02, 0.05, 0.03, 0.06, 0.0, -0.2;
  return gradient;
}

Strain symmetric_part(const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  Strain rows;
  rows << strain(0, 0), strain(1, 1), strain(2, 2), strain(0, 1), strain(0, 2), strain(1, 2);
  return rows;
}

Displaced affine(const Eigen::Matrix3Xd& now, const Eigen::Matrix3d& gradient) {
  return {now, (Eigen::Matrix3d::Identity() + gradient).inverse() * now};
}

double largest_error(const Eigen::Matrix<double, 6, Eigen::Dynamic>& strains, const Strain& expected) {
  return (strains.colwise() - expected).cwiseAbs().maxCoeff();
}

TEST(SphereStrains, OfAnAffineMotionAreExactHoweverLarge) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  EXPECT_LT(largest_error(flow.sphere_strains(affine(packing.positions, stretch())), symmetric_part(stretch())), 1e-12);
}

TEST(SphereStrains, SeeNoTranslation) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  const Displaced moved{packing.positions, packing.positions.colwise() + Eigen::Vector3d(0.3, -0.2, 0.1)};
  EXPECT_LT(flow.sphere_strains(moved).cwiseAbs().maxCoeff(), 1e-12);
}

/// Grains have gone through the sides, which have come nearer; what was a brick leans now.
TEST(SphereStrains, OfAPeriodicCellThatChangesAreExact) {
  const PackingArrays packing = data_packing("bed_periodic_64.csv");
  Box box;
  box.periodic = {true, true, true};
  const Flow flow = flow_through(packing, box);
  Random random(3);
  Eigen::Matrix3Xd unwrapped = packing.positions;
  for (Eigen::Index k = 0; k < unwrapped.cols(); ++k)
    unwrapped.col(k) += random.in_cube(-2.5, 2.5).array().round().matrix();
  Eigen::Matrix3d gradient = stretch();  // the cell's vectors stay in its triangular form
  gradient(1, 0) = gradient(2, 0) = gradient(2, 1) = 0.0;
  const Eigen::Matrix3d back = (Eigen::Matrix3d::Identity() + gradient).inverse();
  Displaced moved = affine(unwrapped, gradient);
  moved.edges_before = back.diagonal();
  EXPECT_THROW(flow.sphere_strains(affine(unwrapped, gradient)), InputError);  // of which cell?
  moved.tilt_before = Eigen::Vector3d(back(0, 1), back(0, 2), back(1, 2));
  EXPECT_LT(largest_error(flow.sphere_strains(moved), symmetric_part(gradient)), 1e-12);
}

// The definition by the faces: displacements times areas over the facets that face the sphere from around it.
TEST(SphereStrains, AreThoseOfTheFacetsAroundASphere) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  Eigen::Index middle = 0;
  (packing.positions.colwise() - Eigen::Vector3d::Constant(0.5)).colwise().norm().minCoeff(&middle);
  Random random(4);
  Displaced moved{packing.positions, packing.positions};
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k) moved.before.col(k) += random.in_cube(-1e-3, 1e-3);
  const PoreNetwork& network = flow.network();
  double volume = 0.0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d centre = packing.positions.col(middle);
  for (const auto& corners : network.cell_vertices) {
    const auto own = std::find(corners.begin(), corners.end(), static_cast<int>(middle));
    if (own == corners.end() || *std::min_element(corners.begin(), corners.end()) < 0) continue;
    std::vector<int> others;
    for (const int corner : corners)
      if (corner != *own) others.push_back(corner);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), a = packing.positions.col(others[0]);
    for (const int corner : others) mean += (moved.now - moved.before).col(corner) / 3.0;
    Eigen::Vector3d area = 0.5 * (packing.positions.col(others[1]) - a).cross(packing.positions.col(others[2]) - a);
    if (area.dot(a - centre) < 0.0) area = -area;  // out of the cell
    volume += area.dot(a - centre) / 3.0;
    sum += mean * area.transpose();
  }
  const Eigen::Matrix3d back = Eigen::Matrix3d::Identity() - sum / volume;
  const Strain expected = symmetric_part(back.inverse() - Eigen::Matrix3d::Identity());
  const Strain found = flow.sphere_strains(moved).col(middle);
  EXPECT_GT(found.norm(), 1e-4);
  EXPECT_LT((found - expected).norm(), 1e-12 * found.norm());
}

TEST(SphereStrains, LeaveOutSpheresThatWereNotThere) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  Displaced moved = affine(packing.positions, stretch());
  for (const int k : {3, 77, 400}) moved.before.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Matrix<double, 6, Eigen::Dynamic> strains = flow.sphere_strains(moved);
  for (const int k : {3, 77, 400}) {
    EXPECT_EQ(strains.col(k).norm(), 0.0);
    strains.col(k) = symmetric_part(stretch());
  }
  EXPECT_LT(largest_error(strains, symmetric_part(stretch())), 1e-12);
}

TEST(SphereStrains, OfSpheresThatCameFromElsewhereAreFinite) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  Random random(6);
  Displaced moved{packing.positions, packing.positions};
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k) moved.before.col(k) = random.in_cube(0.0, 1.0);
  const auto strains = flow.sphere_strains(moved);
  EXPECT_TRUE(strains.allFinite());
  EXPECT_LT(strains.cwiseAbs().maxCoeff(), 1e3);
}

TEST(SphereStrains, OfATiltedCellAskHowItWasTilted) {
  const PackingArrays packing = data_packing("bed_periodic_64.csv");
  Box box;
  box.periodic = {true, true, true};
  box.tilt = {0.2, 0.0, 0.0};
  const Flow flow = flow_through(packing, box);
  Displaced still{packing.positions, packing.positions, Eigen::Vector3d::Ones()};
  EXPECT_THROW(flow.sphere_strains(still), InputError);
  still.tilt_before = box.tilt;
  EXPECT_LT(flow.sphere_strains(still).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SphereStrains, OfAnotherPackingAreRefused) {
  const PackingArrays packing = data_packing("packing_500.csv");
  const Flow flow = flow_through(packing, upward_box(Wall::no_slip));
  Displaced moved{packing.positions, packing.positions.leftCols(499)};
  EXPECT_THROW(flow.sphere_strains(moved), InputError);
  moved.before = packing.positions;
  moved.now(1, 4) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(flow.sphere_strains(moved), InputError);
}

}  // namespace
}  // namespace sphere_strains_test
}  // namespace pfv
