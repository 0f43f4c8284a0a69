// SPDX-License-Identifier: GPL-3.0-or-later
// F = S p (Chareyre et al. 2012 eqs. 14, 17, 18).
#include "physics/force_matrix.hpp"

#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/motions.hpp"
#include "support/stages.hpp"
#include "support/yade_rules.hpp"

#include <gtest/gtest.h>

namespace force_matrix_test {
namespace {

using namespace support;

Eigen::VectorXd random_pressures(int pores, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd p(pores);
  for (int i = 0; i < pores; ++i) p[i] = random(-1.0, 1.0);
  return p;
}

/// With the papers' shares.
pfv::ForceMatrix papers_matrix(const Stages& s, pfv::ForceParts parts = {}) {
  return force_matrix_of(s, pfv::ConductanceLaw::hydraulic_radius, parts);
}

Eigen::Matrix3Xd forces_of(const pfv::ForceMatrix& matrix, const Eigen::VectorXd& p) {
  return pfv::multiply(matrix, p).topRows<3>();
}

/// Pressure force on the six faces: p times the pore's base, outwards.
Eigen::Vector3d pressure_on_faces(const Stages& s, const Eigen::VectorXd& p) {
  const auto areas = bases_of(s).area;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < areas.size(); ++c) {
    const auto& contact = s.boundaries.contacts[c];
    sum += p[contact.pore] * areas[c] * pfv::outward_normal(pfv::Face(contact.face));
  }
  return sum;
}

TEST(Forces, OfSpheresAndFacesCancelForAnyPressures) {
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  for (const auto& packing : {data_packing("packing_500.csv"), random_packing(200, 0.02, 0.08, 3),
                              lattice(Lattice::fcc, 3)}) {
    const Stages s = stages_of(packing, box);
    const Eigen::VectorXd p = random_pressures(s.network.pores(), 8);
    for (const auto law :
         {pfv::ConductanceLaw::hydraulic_radius, pfv::ConductanceLaw::open_throat}) {
      const Eigen::Vector3d sum =
          forces_of(force_matrix_of(s, law), p).rowwise().sum() + pressure_on_faces(s, p);
      EXPECT_LT(sum.norm(), 1e-12);
    }
  }
}

TEST(Forces, VanishForAUniformPressure) {
  const Stages s = stages_of(data_packing("packing_100.csv"), pfv::Box{});
  const auto matrix = papers_matrix(s);
  const Eigen::VectorXd p = Eigen::VectorXd::Ones(s.network.pores());
  EXPECT_LT(pfv::multiply(matrix, p).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Forces, ArePressurePlusViscousPart) {
  const Stages s = stages_of(data_packing("packing_100.csv"), pfv::Box{});
  const int n = s.spheres.size();
  const Eigen::VectorXd p = random_pressures(s.network.pores(), 8);
  const auto part = [&](pfv::ForceParts parts) {
    return forces_of(papers_matrix(s, parts), p);
  };
  const Eigen::Matrix3Xd total = part({true, true});
  EXPECT_LT((part({true, false}) + part({false, true}) - total).norm(), 1e-15 * n);
  EXPECT_TRUE(part({true, false}).rightCols(6).isZero(0.0));  // faces: viscous shares only
}

// Eq. 18, and with the open-throat law more for a sphere that is more than four times smaller than the
// largest of its facet: gamma max(1, r_max / (4 r)).
TEST(ViscousShares, AreSurfacesAndFavourSmallSpheresInBigPores) {
  const Stages s = stages_of(nine_spheres(0.1), upward_box(pfv::Wall::no_slip));
  const auto papers = pfv::viscous_shares(pfv::ConductanceLaw::hydraulic_radius, s.network,
                                          s.throats, s.spheres);
  const auto open =
      pfv::viscous_shares(pfv::ConductanceLaw::open_throat, s.network, s.throats, s.spheres);
  int with_small = 0;
  for (int t = 0; t < s.network.throats(); ++t) {
    const int begin = s.network.throat_facets[t], end = s.network.throat_facets[t + 1];
    double sum = 0.0, gamma = 0.0, weighted = 0.0;
    const auto weight = [&](int f, int k) {
      const bool small = s.network.facet_vertices[f][k] == 8;
      with_small += small;
      return small ? 10.0 / 4.0 : 1.0;
    };
    for (int f = begin; f < end; ++f)
      for (int k = 0; k < 3; ++k) {
        sum += open[f][k];
        gamma += s.throats.facet_gamma[f][k];
        weighted += weight(f, k) * s.throats.facet_gamma[f][k];
      }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    for (int f = begin; f < end; ++f)
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(papers[f][k], s.throats.facet_gamma[f][k] / gamma, 1e-14);
        EXPECT_NEAR(open[f][k], weight(f, k) * s.throats.facet_gamma[f][k] / weighted, 1e-14);
      }
  }
  EXPECT_GT(with_small, 0);
}

// A second implementation, facet by facet: sectors and surface shares by the signed partition.
TEST(Forces, AreSectorsAndSurfaceSharesFacetByFacet) {
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  const Stages s = stages_of(random_packing(150, 0.03, 0.07, 21), box);
  const Eigen::VectorXd p = random_pressures(s.network.pores(), 5);
  Eigen::Matrix3Xd expected = Eigen::Matrix3Xd::Zero(3, s.spheres.size() + 6);
  int crossing = 0;
  for (int f = 0; f < s.network.facets(); ++f) {
    const auto& facet = s.network.facet_vertices[f];
    const auto& cells = s.network.facet_cells[f];
    const YadeThroat throat = yade_throat(s, f, {false, false});
    // an obtuse facet whose disc crosses the opposite side shares its area in another way
    const auto& disc = s.throats.facet_disc[f];
    for (int i = 0; i < 3; ++i) crossing += std::abs(disc[i] - throat.sector[i]) > 1e-12;
    const Eigen::Vector3d push =
        (p[s.network.cell_pore[cells[0]]] - p[s.network.cell_pore[cells[1]]]) *
        pfv::unit_normal(facet, s.spheres);
    double fluid = pfv::area_vector(facet, s.spheres).norm();
    for (const double d : disc) fluid -= d;
    for (int i = 0; i < 3; ++i) {
      const int row = pfv::is_wall(facet[i]) ? s.spheres.size() + pfv::wall_number(facet[i])
                                             : facet[i];
      const bool rubs = !pfv::is_wall(facet[i]) ||
                        !s.box.faces[pfv::wall_number(facet[i])].boundary.is_open();
      if (rubs) expected.col(row) += (disc[i] + fluid * throat.share[i]) * push;
    }
  }
  EXPECT_LT(crossing, s.network.facets() / 100);
  const Eigen::Matrix3Xd forces = forces_of(papers_matrix(s), p);
  // pores on the rim of a pressure face rub on one side only: other shares for them
  std::vector<char> rim(s.spheres.size(), 0);
  for (int c = 0; c < s.network.cells(); ++c) {
    const auto faces = s.network.pore_faces[s.network.cell_pore[c]];
    if (faces & 0b110000 || faces & 0b001111)
      for (const int v : s.network.cell_vertices[c])
        if (!pfv::is_wall(v) && faces & 0b110000) rim[v] = 1;
  }
  int compared = 0;
  for (int k = 0; k < s.spheres.size(); ++k)
    if (!rim[k]) {
      EXPECT_LT((forces.col(k) - expected.col(k)).norm(), 1e-14);
      ++compared;
    }
  EXPECT_GT(compared, 20);
}

TEST(Forces, OfPressureFlowDoNotKnowTheViscosity) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Fluid thick = viscosity_one();
  thick.viscosity = 1024.0;  // a power of two changes no digit
  pfv::Flow a(upward_box(pfv::Wall::no_slip), viscosity_one());
  pfv::Flow b(upward_box(pfv::Wall::no_slip), thick);
  EXPECT_TRUE(a.evaluate(packing.view()).total == b.evaluate(packing.view()).total);
  EXPECT_EQ(a.report().inflow, 1024.0 * b.report().inflow);
  EXPECT_NEAR(*a.report().permeability / *b.report().permeability, 1.0, 1e-15);
}

TEST(Forces, OfMovingGrainsAreLinearInViscosityAndVelocity) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = -packing.positions;
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  const auto forces = [&](double viscosity, double factor) {
    pfv::PackingArrays moving = packing;
    moving.velocities *= factor;
    pfv::Fluid fluid;
    fluid.viscosity = viscosity;
    pfv::Flow flow(box, fluid);
    return Eigen::Matrix3Xd(flow.evaluate(moving.view()).total);
  };
  const Eigen::Matrix3Xd one = forces(1.0, 1.0);
  EXPECT_TRUE(forces(1024.0, 1.0) == 1024.0 * one);
  EXPECT_TRUE(forces(1.0, -0.5) == -0.5 * one);
  EXPECT_LT((forces(3.0, 1.0) - 3.0 * one).norm(), 1e-12 * one.norm());  // of the solver
}

TEST(Buoyancy, IsAddedOnceToEachSphere) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Fluid heavy = viscosity_one();
  heavy.density = 900.0;
  heavy.gravity = {1.0, 0.0, -10.0};
  pfv::Options split;
  split.split_forces = true;
  pfv::Flow without(upward_box(pfv::Wall::no_slip), viscosity_one(), split);
  pfv::Flow with(upward_box(pfv::Wall::no_slip), heavy, split);
  const pfv::Forces& dry = without.evaluate(packing.view());
  const pfv::Forces& wet = with.evaluate(packing.view());
  for (int k = 0; k < packing.radii.size(); ++k) {
    const Eigen::Vector3d lift =
        -900.0 * 4.0 / 3.0 * pi * std::pow(packing.radii[k], 3) * heavy.gravity;
    EXPECT_LT((wet.total.col(k) - dry.total.col(k) - lift).norm(), 1e-14 * lift.norm());
    EXPECT_LT((wet.pressure.col(k) - dry.pressure.col(k) - lift).norm(), 1e-14 * lift.norm());
    EXPECT_TRUE(wet.viscous.col(k) == dry.viscous.col(k));
  }
  // the balance is about the flow's forces: buoyancy is no part of it
  EXPECT_LT(with.report().force_balance_error, 1e-14);
}

TEST(Buoyancy, CanBeLeftOut) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Fluid heavy = viscosity_one();
  heavy.gravity = {0.0, 0.0, -10.0};
  pfv::Options options;
  options.buoyancy = false;
  pfv::Flow with(upward_box(pfv::Wall::no_slip), heavy, options);
  pfv::Flow without(upward_box(pfv::Wall::no_slip), viscosity_one());
  EXPECT_TRUE(with.evaluate(packing.view()).total == without.evaluate(packing.view()).total);
}

TEST(SpherePressure, IsThePressureWhereItIsUniform) {
  const auto packing = data_packing("packing_100.csv");
  pfv::Options options;
  options.sphere_pressure = true;
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 7.0, pfv::Face::zhi, 7.0, pfv::Wall::no_slip),
                 viscosity_one(), options);
  const Eigen::VectorXd mean = flow.evaluate(packing.view()).sphere_pressure;
  EXPECT_LT((mean.array() - 7.0).abs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace force_matrix_test
