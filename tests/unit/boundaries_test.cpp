// SPDX-License-Identifier: GPL-3.0-or-later
// What faces and patches impose on the pores.
#include "network/pore_boundaries.hpp"

#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace boundaries_test {
namespace {

using namespace support;
using pfv::Boundary;
using pfv::Face;

struct Result {
  pfv::Report report;
  Eigen::VectorXd pressures;
  pfv::PoreNetwork network;
  Eigen::Matrix3Xd forces;
};

Result solve(const pfv::PackingArrays& packing, const pfv::Box& box) {
  pfv::Flow flow(box, viscosity_one());
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  return {flow.report(), flow.pore_pressures(), flow.network(), forces};
}

double flux(const Result& r, Face face) { return r.report.faces[static_cast<int>(face)].flux; }

TEST(Boundaries, OnlyImposedFluxesLetInWhatTheirValueSays) {
  pfv::Box box;
  box[Face::xlo].boundary = Boundary::flux(3.0);
  box[Face::xhi].boundary = Boundary::pressure(5.0);
  box.patches.push_back({Face::zhi, {0.2, 0.6, 0.2, 0.6}, Boundary::flux(-2.0)});
  const pfv::Container container(box);
  EXPECT_EQ(pfv::imposed_inflow(container, static_cast<int>(Face::xlo)), 3.0);
  EXPECT_EQ(pfv::imposed_inflow(container, static_cast<int>(Face::xhi)), 0.0);
  EXPECT_EQ(pfv::imposed_inflow(container, static_cast<int>(Face::ylo)), 0.0);
  EXPECT_EQ(pfv::imposed_inflow(container, pfv::patch_number(container, 0)), -2.0);
}

TEST(Boundaries, AnUnknownKindIsAnsweredWithAllThatThereAre) {
  Boundary boundary;
  boundary.kind = static_cast<Boundary::Kind>(99);
  try {
    pfv::check(boundary, "face xlo");
    FAIL();
  } catch (const pfv::InputError& error) {
    for (const pfv::BoundaryKind& one : pfv::boundary_kinds)
      EXPECT_NE(std::string(error.what()).find(one.name), std::string::npos) << error.what();
  }
}

TEST(FluxFaces, GiveBackThePressureDifferenceThatDroveTheFlux) {
  const auto packing = data_packing("packing_500.csv");
  const Result driven = solve(packing, upward_box(pfv::Wall::no_slip));
  pfv::Box box = upward_box(pfv::Wall::no_slip);
  box[Face::zlo].boundary = Boundary::flux(flux(driven, Face::zlo));
  const Result fed = solve(packing, box);
  // of the solver: measured 1.4e-12
  EXPECT_LT((fed.pressures - driven.pressures).cwiseAbs().maxCoeff(), 3e-12);
  EXPECT_LT((fed.forces - driven.forces).norm(), 3e-12 * driven.forces.norm());
  EXPECT_NEAR(*fed.report.permeability / *driven.report.permeability, 1.0, 3e-12);
  EXPECT_NEAR(flux(fed, Face::zlo) / flux(driven, Face::zlo), 1.0, 1e-12);
}

TEST(FluxFaces, PositiveIsIntoTheBoxWhicheverFace) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  for (const Face face : pfv::all_faces)
    for (const double q : {2.0, -2.0}) {
      pfv::Box box;
      const Face opposite = static_cast<Face>(static_cast<int>(face) ^ 1);
      box[face].boundary = Boundary::flux(q);
      box[opposite].boundary = Boundary::pressure(0.0);
      const Result r = solve(packing, box);
      EXPECT_NEAR(flux(r, face), q, 1e-11);
      EXPECT_NEAR(flux(r, opposite), -q, 1e-11);
      EXPECT_NEAR(r.report.inflow, 2.0, 1e-11);
      EXPECT_NEAR(r.report.outflow, 2.0, 1e-11);
      EXPECT_GT(q * r.pressures.dot(Eigen::VectorXd::Ones(r.pressures.size())), 0.0);
      // the fluid pushes the grains along the flow
      EXPECT_LT(q * r.forces.row(pfv::axis_of(face)).sum() *
                    pfv::outward_normal(face)[pfv::axis_of(face)], 0.0);
    }
}

/// Pores of a face, with the place of each.
std::vector<int> pores_on(const pfv::PoreNetwork& network, Face face) {
  std::vector<int> pores;
  for (int p = 0; p < network.pores(); ++p)
    if (network.pore_faces[p] >> static_cast<int>(face) & 1) pores.push_back(p);
  return pores;
}

TEST(PressureProfiles, AreTakenAtThePoresPlaceAndTime) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  pfv::Box box;
  box[Face::zhi].boundary.kind = Boundary::Kind::pressure;
  box[Face::zhi].boundary.profile = [](const Eigen::Vector3d& x, double t) {
    return 1.0 + std::cos(pi * x[0]) + 10.0 * t + x[2];
  };
  pfv::Flow flow(box, viscosity_one());
  flow.step(packing.view(), 0.25);
  flow.step(packing.view(), 0.5);
  const auto& network = flow.network();
  for (const int p : pores_on(network, Face::zhi)) {
    const double x = network.pore_centres(0, p);
    EXPECT_NEAR(flow.pore_pressures()[p], 1.0 + std::cos(pi * x) + 7.5 + 1.0, 1e-13);
  }
  EXPECT_LT(std::abs(flow.report().mass_error), 2e-15);
  EXPECT_GT(flow.report().faces[static_cast<int>(Face::zhi)].force_pressure[2], 9.0);
}

TEST(PoresOnSeveralFaces, TakeTheMeanOfTheirPressures) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  pfv::Box box;
  box[Face::xlo].boundary = Boundary::pressure(2.0);
  box[Face::zhi].boundary = Boundary::pressure(6.0);
  box[Face::ylo].boundary = Boundary::flux(0.0);
  const Result r = solve(packing, box);
  int both = 0;
  for (const int p : pores_on(r.network, Face::xlo)) {
    const bool top = r.network.pore_faces[p] >> static_cast<int>(Face::zhi) & 1;
    EXPECT_EQ(r.pressures[p], top ? 4.0 : 2.0);
    both += top;
  }
  EXPECT_GT(both, 0);
}

TEST(PoresOnSeveralFaces, TakeTheFirstFluxFace) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  pfv::Box box;
  box[Face::xlo].boundary = Boundary::flux(1.0);
  box[Face::ylo].boundary = Boundary::flux(-0.25);
  box[Face::zhi].boundary = Boundary::pressure(0.0);
  const Result r = solve(packing, box);
  EXPECT_NEAR(flux(r, Face::xlo), 1.0, 1e-11);
  EXPECT_NEAR(flux(r, Face::ylo), -0.25, 1e-11);
  double shared = 0.0;
  for (const int p : pores_on(r.network, Face::xlo))
    if (!(r.network.pore_faces[p] >> static_cast<int>(Face::zhi) & 1)) shared = r.pressures[p];
  for (const int p : pores_on(r.network, Face::xlo))
    if (!(r.network.pore_faces[p] >> static_cast<int>(Face::zhi) & 1)) {
      EXPECT_EQ(r.pressures[p], shared);  // on ylo, too
    }
}

pfv::Patch patch(Face face, std::array<double, 4> rectangle, Boundary boundary) {
  pfv::Patch p;
  p.face = face;
  p.rectangle = rectangle;
  p.boundary = boundary;
  return p;
}

TEST(Patches, TakeThePoresInTheirRectangleInTheOrderOfTheAxes) {
  const auto packing = random_packing(200, 0.03, 0.05, 4);
  pfv::Box box;
  box[Face::xlo].boundary = Boundary::pressure(0.0);
  box.patches = {patch(Face::yhi, {0.1, 0.5, 0.6, 0.9}, Boundary::pressure(1.0))};
  const Result r = solve(packing, box);
  int inside = 0;
  for (const int p : pores_on(r.network, Face::yhi)) {
    if (r.network.pore_faces[p] & 1) continue;  // xlo holds these
    const double x = r.network.pore_centres(0, p), z = r.network.pore_centres(2, p);
    const bool in = x >= 0.1 && x <= 0.5 && z >= 0.6 && z <= 0.9;
    EXPECT_EQ(r.pressures[p] == 1.0, in);
    inside += in;
  }
  EXPECT_GT(inside, 2);
  EXPECT_GT(flux(r, Face::yhi), 0.0);
  EXPECT_NEAR(flux(r, Face::yhi) + flux(r, Face::xlo), 0.0, 1e-13);
  EXPECT_FALSE(r.report.permeability.has_value());
}

TEST(Patches, WithoutAPoreTakeTheNearestOne) {
  const auto packing = random_packing(30, 0.06, 0.1, 4);
  pfv::Box box;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box.patches = {patch(Face::zhi, {0.5, 0.5001, 0.5, 0.5001}, Boundary::pressure(1.0))};
  const Result r = solve(packing, box);
  int nearest = -1, holders = 0;
  double least = 2.0;
  for (const int p : pores_on(r.network, Face::zhi)) {
    const double d = std::hypot(r.network.pore_centres(0, p) - 0.50005,
                                r.network.pore_centres(1, p) - 0.50005);
    if (d < least) {
      least = d;
      nearest = p;
    }
    holders += r.pressures[p] == 1.0;
  }
  EXPECT_EQ(holders, 1);
  EXPECT_EQ(r.pressures[nearest], 1.0);
}

TEST(Patches, TheLaterOneWins) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  pfv::Box box;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  const std::array<double, 4> all{0.0, 1.0, 0.0, 1.0};
  box.patches = {patch(Face::zhi, all, Boundary::pressure(1.0)),
                 patch(Face::zhi, all, Boundary::pressure(2.0))};
  const Result r = solve(packing, box);
  for (const int p : pores_on(r.network, Face::zhi)) EXPECT_EQ(r.pressures[p], 2.0);
}

TEST(Patches, TakeTheirFluxBesideOneOfTheFace) {
  const auto packing = random_packing(200, 0.03, 0.05, 4);
  pfv::Box box;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::flux(0.5);
  box.patches = {patch(Face::zhi, {0.3, 0.7, 0.3, 0.7}, Boundary::flux(-0.2))};
  const Result r = solve(packing, box);
  EXPECT_NEAR(flux(r, Face::zhi), 0.3, 1e-11);
  EXPECT_NEAR(r.report.inflow, 0.5, 1e-11);
  EXPECT_NEAR(r.report.outflow, 0.5, 1e-11);
}

TEST(Patches, OfOneFaceWithAPressureSealTheRest) {
  // the seed's Darcy example: a small outlet in an otherwise sealed wall
  const auto packing = random_packing(200, 0.03, 0.05, 4);
  pfv::Box box;
  box[Face::ylo].boundary = Boundary::flux(1e-5);
  box.patches = {patch(Face::yhi, {0.4, 0.6, 0.4, 0.6}, Boundary::pressure(0.0))};
  const Result r = solve(packing, box);
  EXPECT_NEAR(r.report.outflow / 1e-5, 1.0, 1e-11);
  EXPECT_LT(std::abs(r.report.mass_error), 2e-15);
}

TEST(FluxFaces, WithoutAPoreOfTheirOwnAreRefused) {
  // one sphere: every pore touches three faces, and those of zlo all belong to a pressure
  pfv::Box box;
  for (const Face face : {Face::xlo, Face::xhi, Face::ylo, Face::yhi})
    box[face].boundary = Boundary::pressure(0.0);
  box[Face::zlo].boundary = Boundary::flux(1.0);
  pfv::Flow flow(box, viscosity_one());
  const auto packing = packing_of({{0.5, 0.5, 0.5, 0.2}});
  expect_line(refusal([&] { flow.evaluate(packing.view()); }), "face zlo");
}

TEST(Boundaries, APatchTakesThePoresOnAllItsBordersAlike) {
  // touching spheres have their pores on the grid of their corners, which no decimal meets exactly
  const double step = 0.005;
  std::vector<support::Sphere> spheres;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 4; ++k)
        spheres.push_back({(i + 0.5) * step, (j + 0.5) * step, (k + 0.5) * step, 0.5 * step});
  pfv::Box box;
  box.upper = {0.1, 0.1, 0.02};
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1.0);
  box.patches.push_back(
      {pfv::Face::zhi, {0.04, 0.06, 0.04, 0.06}, pfv::Boundary::pressure(0.0)});
  pfv::Flow flow(box, pfv::Fluid{});
  const pfv::PackingArrays packing = support::packing_of(spheres);
  flow.evaluate(packing.view());
  const Eigen::Vector3d force = flow.report().force_sum;
  EXPECT_LT(force.head<2>().norm(), 1e-10 * force[2]);
}

}  // namespace
}  // namespace boundaries_test
