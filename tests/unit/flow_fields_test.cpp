// SPDX-License-Identifier: GPL-3.0-or-later
// Pressures at places, over planes, and fluxes of throats.
#include "pfv/pfv.hpp"
#include "results/network_report.hpp"
#include "step/network_builder.hpp"
#include "step/step_scheme.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace flow_fields_test {
namespace {

using namespace support;

// On a simple cubic lattice of n layers the pores lie in n + 1 layers between them, and the
// pressure falls by 1/n from each to the next.
TEST(Fields, OfASimpleCubicLatticeFallInEqualSteps) {
  const int n = 4;
  const auto packing = lattice(Lattice::sc, n);
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one(), hydraulic_radius());
  flow.evaluate(packing.view());
  for (int layer = 0; layer <= n; ++layer) {
    const double z = std::min(std::max(static_cast<double>(layer) / n, 1e-3), 1.0 - 1e-3);
    const double expected = 1.0 - static_cast<double>(layer) / n;
    EXPECT_NEAR(flow.pressure_at({0.5, 0.26, z}), expected, 1e-14);
    EXPECT_NEAR(flow.pressure_at({0.01, 0.99, z}), expected, 1e-14);
    EXPECT_NEAR(flow.plane_pressure(2, z), expected, 1e-14);
  }
  EXPECT_NEAR(flow.mean_pressure(), 0.5, 1e-14);
  EXPECT_NEAR(flow.plane_pressure(0, 0.3), 0.5, 1e-14);
}

TEST(Fields, PressureAtEachPlaceIsThatOfACellWithItsPore) {
  const auto packing = data_packing("packing_500.csv");
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  const pfv::PoreNetwork& network = flow.network();
  int compared = 0;
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    if (pfv::is_wall(cell[3])) continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int v : cell) middle += 0.25 * packing.positions.col(v);
    EXPECT_EQ(flow.pressure_at(middle), flow.pore_pressures()[network.cell_pore[c]]);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(Fields, ThroatFluxesLeaveEachInnerPoreBalanced) {
  const auto packing = data_packing("packing_500.csv");
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  const pfv::PoreNetwork& network = flow.network();
  const auto flux = flow.throat_fluxes();
  const auto& conductance = flow.throat_conductances();
  Eigen::VectorXd net = Eigen::VectorXd::Zero(network.pores());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    // up to what the solve leaves in the pressures (1 Pa): the fluxes are corrected for it
    EXPECT_NEAR(flux[t], conductance[t] * (flow.pore_pressures()[i] - flow.pore_pressures()[j]),
                4e-13 * conductance[t]);  // measured 1.7e-13
    net[i] -= flux[t];
    net[j] += flux[t];
  }
  const pfv::Report report = flow.report();
  double outflow = 0.0;
  for (int p = 0; p < network.pores(); ++p) {
    const bool top = network.pore_faces[p] >> 5 & 1, bottom = network.pore_faces[p] >> 4 & 1;
    if (!top && !bottom) {
      EXPECT_NEAR(net[p], 0.0, 1e-14 * report.inflow);
    }
    if (top) outflow += net[p];
  }
  EXPECT_NEAR(outflow / report.outflow, 1.0, 1e-13);
}

/// Mass error of a steady flow after an error in each unknown pressure.
double mass_error_after(double error) {
  const auto packing = data_packing("packing_500.csv");
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  const pfv::Fluid fluid = viscosity_one();
  const pfv::Options options;
  const auto team = std::make_shared<pfv::Team>(1);
  const pfv::Problem problem{box, fluid, options, team};
  pfv::WorkRecord work;
  const auto built = pfv::derive_network(packing.view(), problem, work);
  pfv::factor_pressures(*built, problem, 0.0, work);
  pfv::Solution solution;
  solution.container = box;
  solution.geometry = built->geometry;
  solution.growth = pfv::growth_of(box, solution.geometry, *built, 0.0);
  pfv::ExplicitStep().find({*built, problem, packing.view(), nullptr, work}, solution);
  for (std::size_t p = 0; p < built->unknowns.of_pore.size(); ++p)
    if (built->unknowns.of_pore[p] != pfv::Unknowns::imposed)
      solution.relative_pressures[static_cast<Eigen::Index>(p)] *= 1.0 + error;
  std::int64_t solves = 0;
  const pfv::Balance balance = pfv::balance_of(*built, solution, solves);
  return std::abs(pfv::network_report(*built, problem, solution, balance, solves).mass_error);
}

TEST(Fields, FluxesAreCorrectedForRoundOffAlone) {
  EXPECT_LT(mass_error_after(1e-12), 1e-14);
  // what is no round-off is left for the balance to show
  EXPECT_GT(mass_error_after(1e-5), 1e-6);
}

TEST(Fields, PoreVolumesAreTheFluidOfTheBox) {
  const auto packing = random_packing(100, 0.04, 0.08, 4);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  EXPECT_NEAR(flow.pore_volumes().sum(), 1.0 - solid_volume(packing), 1e-13);
  EXPECT_NEAR(flow.report().pore_volume, 1.0 - solid_volume(packing), 1e-13);
}

TEST(EmptySpace, IsFoundAboveABedAndNotWithin) {
  const pfv::PackingArrays dense = support::data_packing("packing_500.csv");
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(dense.view());
  EXPECT_EQ(flow.empty_space().part, 0.0);
  EXPECT_FALSE(pfv::warning_of(flow.empty_space()));
  pfv::PackingArrays bed;
  for (Eigen::Index k = 0; k < dense.ids.size(); ++k) {
    if (dense.positions(2, k) > 0.5) continue;
    const Eigen::Index n = bed.ids.size();
    bed.ids.conservativeResize(n + 1);
    bed.positions.conservativeResize(3, n + 1);
    bed.radii.conservativeResize(n + 1);
    bed.ids[n] = dense.ids[k];
    bed.positions.col(n) = dense.positions.col(k);
    bed.radii[n] = dense.radii[k];
  }
  flow.evaluate(bed.view());
  const pfv::EmptySpace empty = flow.empty_space();
  // half of the box beside the pores of the other half, some 40 % of it
  EXPECT_NEAR(empty.part, 0.5 / (0.5 + 0.5 * 0.4), 0.08);
  EXPECT_GT(empty.place[2], 0.5);
  EXPECT_NE(pfv::warning_of(empty)->find("% of the pore volume"), std::string::npos);
}

// The figures beside EmptySpace: what sets a packing apart from room that is none of its own.
TEST(EmptySpace, OfLoosePackingsSuspensionsAndABoxAroundACylinder) {
  const auto part_in = [](const pfv::PackingArrays& packing) {
    pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
    flow.evaluate(packing.view());
    return flow.empty_space().part;
  };
  EXPECT_NEAR(part_in(pfv::dense_packing(1000, 0.4)), 0.02, 0.005);
  EXPECT_NEAR(part_in(pfv::dense_packing(1000, 0.2)), 0.17, 0.005);
  const pfv::PackingArrays dense = support::data_packing("packing_500.csv");
  std::vector<Eigen::Index> inside;
  for (Eigen::Index k = 0; k < dense.ids.size(); ++k)
    if ((dense.positions.col(k).head<2>() - Eigen::Vector2d(0.5, 0.5)).norm() < 0.47) inside.push_back(k);
  pfv::PackingArrays cylinder;
  cylinder.ids = dense.ids(inside);
  cylinder.positions = dense.positions(Eigen::all, inside);
  cylinder.radii = dense.radii(inside);
  EXPECT_NEAR(part_in(cylinder), 0.26, 0.005);
}

TEST(Queries, RefuseAnAxisThatIsNone) {
  const auto packing = random_packing(20, 0.05, 0.1, 4);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  flow.evaluate(packing.view());
  for (const int axis : {-1, 3}) {
    EXPECT_THROW(flow.plane_pressure(axis, 0.5), pfv::InputError);
    EXPECT_THROW(flow.plane_flux(axis, 0.5), pfv::InputError);
    EXPECT_THROW(flow.slice_means(axis, 0.2, 0.8), pfv::InputError);
  }
}

}  // namespace
}  // namespace flow_fields_test
