// SPDX-License-Identifier: GPL-3.0-or-later
// Periodic cells that lean: the same packing in other cells of the same lattice.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace tilted_cell_test {
namespace {

using namespace support;

pfv::Box cell_of(const Eigen::Vector3d& edges, const Eigen::Vector3d& tilt) {
  pfv::Box box;
  box.lower = {-0.3, 0.1, 2.0};
  box.upper = box.lower + edges;
  box.periodic = {true, true, true};
  box.tilt = tilt;
  return box;
}

/// A packing of the brick together with its next `periods` along one lattice vector.
pfv::PackingArrays repeated(const pfv::PackingArrays& packing, const Eigen::Vector3d& period, int periods) {
  std::vector<Sphere> spheres;
  for (int n = 0; n < periods; ++n)
    for (Eigen::Index k = 0; k < packing.radii.size(); ++k) {
      const Eigen::Vector3d place = packing.positions.col(k) + n * period;
      spheres.push_back({place.x(), place.y(), place.z(), packing.radii[k]});
    }
  return packing_of(spheres);
}

pfv::Report report_of(const pfv::PackingArrays& packing, const pfv::Box& box) {
  pfv::Flow flow(box, viscosity_one(), {});
  flow.evaluate(packing.view());
  return flow.report();
}

void expect_same(const pfv::Report& a, const pfv::Report& b) {
  ASSERT_TRUE(a.permeability_tensor && b.permeability_tensor);
  EXPECT_LT((*a.permeability_tensor - *b.permeability_tensor).norm(), 1e-10 * b.permeability_tensor->norm());
  EXPECT_NEAR(a.porosity, b.porosity, 1e-12);
}

// By a whole edge it is the same lattice.
TEST(TiltedCell, ATiltByAWholeEdgeChangesNothing) {
  const Eigen::Vector3d edges(1.2, 1.1, 0.8);
  const pfv::Box straight = cell_of(edges, {0, 0, 0});
  const auto packing = random_packing(120, 0.05, 0.08, 11, straight);
  const pfv::Report wanted = report_of(packing, straight);
  for (const Eigen::Vector3d& tilt : {Eigen::Vector3d(1.2, 0, 0), Eigen::Vector3d(0, -1.2, 0), Eigen::Vector3d(0, 0, 1.1),
                                      Eigen::Vector3d(-1.2, 1.2, 1.1)}) {
    const pfv::Report report = report_of(packing, cell_of(edges, tilt));
    EXPECT_EQ(report.pores, wanted.pores);
    expect_same(report, wanted);
  }
}

// Tilted by half an edge, two periods are a straight cell.
TEST(TiltedCell, TwoPeriodsOfATiltByHalfAnEdgeAreAStraightCell) {
  const Eigen::Vector3d edges(1.2, 1.1, 0.8);
  struct {
    Eigen::Vector3d tilt, twice, period;
  } const cases[]{{{0.6, 0, 0}, {1.2, 2.2, 0.8}, {0.6, 1.1, 0}},
                  {{0, 0.6, 0}, {1.2, 1.1, 1.6}, {0.6, 0, 0.8}},
                  {{0, 0, -0.55}, {1.2, 1.1, 1.6}, {0, -0.55, 0.8}},
                  {{0, 0.6, 0.55}, {1.2, 1.1, 1.6}, {0.6, 0.55, 0.8}}};
  for (const auto& one : cases) {
    const pfv::Box leaning = cell_of(edges, one.tilt);
    const auto packing = random_packing(120, 0.05, 0.08, 12, cell_of(edges, {0, 0, 0}));
    const pfv::Report report = report_of(packing, leaning);
    const pfv::Report wanted = report_of(repeated(packing, one.period, 2), cell_of(one.twice, {0, 0, 0}));
    EXPECT_EQ(2 * report.pores, wanted.pores);
    expect_same(report, wanted);
  }
}

TEST(TiltedCell, ForcesCarryTheGradientAndFollowTheGrainsImages) {
  const Eigen::Vector3d edges(1.2, 1.1, 0.8);
  pfv::Box box = cell_of(edges, {0.3, -0.2, 0.4});
  box.pressure_gradient = {1.0, -2.0, 0.5};
  auto packing = random_packing(120, 0.05, 0.08, 13, cell_of(edges, {0, 0, 0}));
  pfv::Flow flow(box, viscosity_one(), {});
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  EXPECT_LT((forces.rowwise().sum() + box.volume() * box.pressure_gradient).norm(), 1e-12);
  EXPECT_LT(flow.report().force_balance_error, 1e-13);
  for (Eigen::Index k = 0; k < packing.positions.cols(); ++k)  // somewhere else on the lattice
    packing.positions.col(k) += static_cast<double>(k % 3 - 1) * Eigen::Vector3d(0.3, 1.1, 0.0) +
                                static_cast<double>(k % 4 - 2) * Eigen::Vector3d(-0.2, 0.4, 0.8);
  EXPECT_LT((flow.evaluate(packing.view()).total - forces).norm(), 1e-11 * forces.norm());
  EXPECT_EQ(flow.retriangulations(), 0);
}

TEST(TiltedCell, WhatItCannotBeIsRefused) {
  pfv::Box box = cell_of({1.2, 1.1, 0.8}, {0, 0, 0.4});
  box.periodic[1] = false;
  EXPECT_THROW(pfv::check(box), pfv::InputError);
  box.periodic[1] = true;
  EXPECT_NO_THROW(pfv::check(box));
  box[pfv::Face::xhi].velocity = 1.0;
  EXPECT_THROW(pfv::check(box), pfv::InputError);
}

}  // namespace
}  // namespace tilted_cell_test
