// SPDX-License-Identifier: GPL-3.0-or-later
// V^k, the resistance of the fluid to the motion of one sphere alone (Catalano 2012 eqs. 4.10-4.16), and
// the papers' estimates of the time step that are made of it.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

namespace viscosity_matrices_test {
namespace {

using namespace support;

pfv::Box open_box() {
  return pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::symmetry);
}

std::vector<int> all_of(const pfv::PackingArrays& packing) {
  std::vector<int> columns(static_cast<std::size_t>(packing.radii.size()));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

std::vector<Eigen::Matrix3d> matrices(const pfv::PackingArrays& packing, const pfv::Box& box,
                                      const pfv::Fluid& fluid, pfv::Options options = {}) {
  pfv::Flow flow(box, fluid, options);
  flow.evaluate(packing.view());
  return flow.viscosity_matrices(all_of(packing));
}

double largest(const Eigen::Matrix3d& matrix) {
  return matrix.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(ViscosityMatrices, AreTheForcesOnASphereThatMovesAlone) {
  auto packing = data_packing("packing_100.csv");
  for (const bool shear : {false, true}) {
    pfv::Options options;
    options.shear_viscous = shear;
    pfv::Flow flow(open_box(), viscosity_one(), options);
    flow.evaluate(packing.view());
    const std::vector<int> some{0, 17, 99};
    const auto found = flow.viscosity_matrices(some);
    for (std::size_t i = 0; i < some.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) {
        packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
        packing.velocities(axis, some[i]) = 1.0;
        const Eigen::Vector3d force = flow.evaluate(packing.view()).total.col(some[i]);
        EXPECT_LT((force + found[i].col(axis)).norm(), 1e-12 * found[i].norm());
      }
  }
}

// With all other masses infinite the operator is that of the one that is free: three directions, found but for a
// residual of 0.1 %, by which the limit is on the safe side.
TEST(ViscosityMatrices, GiveTheTrueLimitOfAPackingWhereOneSphereIsFree) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Flow flow(open_box(), viscosity_one());
  flow.evaluate(packing.view());
  for (const int free : {3, 50, 88}) {
    Eigen::VectorXd masses =
        Eigen::VectorXd::Constant(packing.radii.size(), std::numeric_limits<double>::infinity());
    masses[free] = 2.5;
    const double alone = pfv::viscous_time_step(2.5, flow.viscosity_matrices({free})[0]);
    const double ratio = flow.time_step_limit(masses) / alone;
    EXPECT_GT(ratio, 0.999);
    EXPECT_LT(ratio, 1.0 + 1e-9);
  }
}

TEST(ViscosityMatrices, BrakeInEachDirectionAndAreSymmetric) {
  for (const auto& packing : {data_packing("packing_100.csv"), random_packing(150, 0.02, 0.1, 8)})
    for (const Eigen::Matrix3d& v : matrices(packing, open_box(), viscosity_one())) {
      const Eigen::Matrix3d even = 0.5 * (v + v.transpose());
      const Eigen::Vector3d drags = even.selfadjointView<Eigen::Lower>().eigenvalues();
      EXPECT_GT(drags.minCoeff(), 0.0);
      EXPECT_LT((v - even).norm(), 1e-12 * even.norm());
    }
}

// In the direction that resists least, the 100 grains feel 1.8 times Stokes' drag 3 pi mu d at least, the 500
// 1.1 times.
TEST(ViscosityMatrices, ShearForcesBrakeInEachDirection) {
  pfv::Options options;
  options.shear_viscous = true;
  for (const char* name : {"packing_100.csv", "packing_500.csv"}) {
    const auto packing = data_packing(name);
    const auto found = matrices(packing, open_box(), viscosity_one(), options);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Eigen::Matrix3d even = 0.5 * (found[k] + found[k].transpose());
      const double drag = even.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
      const double radius = packing.radii[static_cast<Eigen::Index>(k)];
      least = std::min(least, drag / (6.0 * std::acos(-1.0) * radius));
    }
    EXPECT_GT(least, 1.0) << name;
  }
}

// Thesis eqs. 4.16-4.17: V* = V/mu belongs to the geometry alone and goes with its size.
TEST(ViscosityMatrices, GoWithTheViscosityAndWithTheSizeOfAll) {
  auto packing = data_packing("packing_100.csv");
  const auto one = matrices(packing, open_box(), viscosity_one());
  pfv::Fluid thick = viscosity_one();
  thick.viscosity = 1e4;
  const auto thicker = matrices(packing, open_box(), thick);
  packing.positions *= 1e-3;
  packing.radii *= 1e-3;
  pfv::Box small = open_box();
  small.upper *= 1e-3;
  const auto smaller = matrices(packing, small, viscosity_one());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_LT((thicker[k] / 1e4 - one[k]).norm(), 1e-11 * one[k].norm());
    EXPECT_LT((smaller[k] * 1e3 - one[k]).norm(), 1e-9 * one[k].norm());
  }
}

TEST(ViscosityMatrices, AreZeroWhereTheFluidDoesNotReach) {
  auto packing = data_packing("packing_100.csv");
  packing.ids.conservativeResize(102);
  packing.ids.tail(2) << 1001, 1002;
  packing.positions.conservativeResize(3, 102);
  packing.positions.col(100) = packing.positions.col(7).array() + 1e-3;  // within sphere 7
  packing.positions.col(101) << 1.5, 0.5, 0.5;            // beyond the box
  packing.radii.conservativeResize(102);
  packing.radii.tail(2) << 0.01, 0.1;
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  const auto found = matrices(packing, open_box(), viscosity_one(), options);
  EXPECT_GT(largest(found[7]), 0.0);
  EXPECT_EQ(largest(found[100]), 0.0);
  EXPECT_EQ(largest(found[101]), 0.0);
  EXPECT_EQ(pfv::viscous_time_step(1.0, found[101]), std::numeric_limits<double>::infinity());
}

TEST(ViscosityMatrices, RefuseASphereThatIsNotThere) {
  const auto packing = packing_of({{0.5, 0.5, 0.5, 0.2}});
  pfv::Flow flow(open_box(), viscosity_one());
  flow.evaluate(packing.view());
  for (const int column : {-1, 1})
    expect_line(refusal([&] { flow.viscosity_matrices({column}); }), "no sphere");
}

// eq. 4.20 is eq. 4.15 with V = 400 mu d: pi rho d² / (1200 mu).
TEST(EstimatedTimeStep, IsThePapersFormula) {
  const double rho = 2600.0, d = 0.003, mu = 250.0;
  const double mass = rho * pi / 6.0 * d * d * d;
  EXPECT_NEAR(pfv::estimated_time_step(mass, d / 2, mu) / (pi * rho * d * d / (1200.0 * mu)), 1.0,
              1e-14);
  EXPECT_NEAR(pfv::viscous_time_step(mass, 400.0 * mu * d * Eigen::Matrix3d::Identity()) /
                  pfv::estimated_time_step(mass, d / 2, mu),
              1.0, 1e-14);
}

}  // namespace
}  // namespace viscosity_matrices_test
