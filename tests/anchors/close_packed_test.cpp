// SPDX-License-Identifier: GPL-3.0-or-later
// The two closest packings in periodic cells whose z axis stands on the close-packed planes: HCP
// (planes ABAB, box 1 x sqrt(3) x sqrt(8/3) diameters, 4 spheres) and FCC (ABCABC, 1 x sqrt(3) x
// sqrt(6), 6 spheres). Symmetry demands k_xx = k_yy and no shear terms, and for FCC k_zz = k_xx as
// in its cubic cell.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace close_packed_test {
namespace {

using namespace support;
using pfv::ConductanceLaw;

constexpr double scales[] = {1.0, 0.99, 0.95, 0.9, 0.8, 0.7};

struct Cell {
  pfv::Box box;
  pfv::PackingArrays packing;
};

/// Close-packed planes of spheres of diameter 1, times `scale`, in this stacking: 0, 1, 2 for A, B,
/// C.
Cell stacked(const std::vector<int>& planes, double scale) {
  const double row = std::sqrt(3.0), layer = std::sqrt(2.0 / 3.0);
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (int second = 0; second < 2; ++second)
      spheres.push_back({0.25 + 0.5 * second,
                         row * (0.1 + std::fmod(0.5 * second + planes[i] / 3.0, 1.0)),
                         layer * (static_cast<double>(i) + 0.3), 0.5 * scale});
  Cell cell;
  cell.box.periodic = {true, true, true};
  cell.box.upper = {1.0, row, layer * static_cast<double>(planes.size())};
  cell.packing = packing_of(spheres);
  return cell;
}

Cell hcp(double scale) { return stacked({0, 1, 0, 1}, scale); }
Cell fcc(double scale) { return stacked({0, 1, 2}, scale); }

Cell jittered(Cell cell, double amplitude) {
  Random random(7);
  for (int k = 0; k < cell.packing.radii.size(); ++k)
    cell.packing.positions.col(k) += amplitude * random.in_cube();
  return cell;
}

Eigen::Matrix3d permeability(const Cell& cell, ConductanceLaw law) {
  pfv::Options options;
  options.conductance = law;
  pfv::Flow flow(cell.box, viscosity_one(), options);
  flow.evaluate(cell.packing.view());
  return *flow.report().permeability_tensor;
}

/// Largest entry of the tensor's difference from diag(k_xx, k_xx, k_zz), over k_xx.
double shear(const Eigen::Matrix3d& k) {
  const Eigen::Vector3d diagonal(k(0, 0), k(0, 0), k(2, 2));
  return (k - diagonal.asDiagonal().toDenseMatrix()).cwiseAbs().maxCoeff() / k(0, 0);
}

constexpr ConductanceLaw laws[] = {ConductanceLaw::hydraulic_radius,
                                   ConductanceLaw::effective_radius, ConductanceLaw::open_throat};

// Measured: 2e-15.
TEST(ClosePacked, AreAlikeInAllDirectionsOfThePlane) {
  for (const ConductanceLaw law : laws)
    for (const double scale : scales) {
      EXPECT_LT(shear(permeability(hcp(scale), law)), 1e-14) << scale;
      EXPECT_LT(shear(permeability(fcc(scale), law)), 1e-14) << scale;
    }
}

TEST(ClosePacked, FccIsAsPermeableAcrossThePlaneAsAlongItAndAsInItsCubicCell) {
  for (const ConductanceLaw law : laws)
    for (const double scale : scales) {
      const Eigen::Matrix3d k = permeability(fcc(scale), law);
      EXPECT_NEAR(k(2, 2) / k(0, 0), 1.0, 1e-14) << scale;
      Cell cubic{pfv::Box{}, lattice(Lattice::fcc, 1, scale)};
      cubic.box.periodic = {true, true, true};
      const double in_diameters = 2.0 * k(0, 0) / permeability(cubic, law)(0, 0) / 4.0;
      EXPECT_NEAR(in_diameters, 1.0, 1e-13) << scale;
    }
}

// The planes have the throats of FCC, so that k_xx is FCC's; across them two cells of one kind
// share faces. Measured k_zz / k_xx: 1.0042 touching to 1.0019 at 0.7 of the radius.
TEST(ClosePacked, HcpIsAsPermeableAlongThePlaneAsFccAndHardlyMoreAcross) {
  for (const ConductanceLaw law : {ConductanceLaw::hydraulic_radius, ConductanceLaw::open_throat})
    for (const double scale : scales) {
      const Eigen::Matrix3d k = permeability(hcp(scale), law);
      EXPECT_NEAR(k(0, 0) / permeability(fcc(scale), law)(0, 0), 1.0, 1e-13) << scale;
      EXPECT_GT(k(2, 2) / k(0, 0), 1.0015) << scale;
      EXPECT_LT(k(2, 2) / k(0, 0), 1.0045) << scale;
    }
}

// Measured: 4e-9 of the permeability, in proportion to the displacement.
TEST(ClosePacked, JitteredBy1em9HaveTheSamePermeability) {
  for (const ConductanceLaw law : laws)
    for (const double scale : scales)
      for (const Cell& cell : {hcp(scale), fcc(scale)}) {
        const Eigen::Matrix3d k = permeability(cell, law);
        const Eigen::Matrix3d moved = permeability(jittered(cell, 1e-9), law);
        EXPECT_LT((moved - k).cwiseAbs().maxCoeff() / k(0, 0), 1e-8) << scale;
      }
}

}  // namespace
}  // namespace close_packed_test
