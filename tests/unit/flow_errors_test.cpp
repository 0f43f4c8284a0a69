// SPDX-License-Identifier: GPL-3.0-or-later
// What leaves the pressure undetermined is refused with the place, or pinned and counted at rest.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace flow_errors_test {
namespace {

using namespace support;

/// Four spheres on a regular tetrahedron of edge a with radius 0.59 a: their discs cover each facet
/// (circumradius 0.577 a), but not its centre (0.612 a): a pore without a way out.
pfv::PackingArrays closed_tetrahedron() {
  const double a = 0.3, r = 0.59 * a, h = a / (2.0 * std::sqrt(2.0));
  return packing_of({{0.5 + h, 0.5 + h, 0.5 + h, r},
                     {0.5 + h, 0.5 - h, 0.5 - h, r},
                     {0.5 - h, 0.5 + h, 0.5 - h, r},
                     {0.5 - h, 0.5 - h, 0.5 + h, r}});
}

/// A 4 x 4 layer of overlapping spheres that closes the box at half its height.
pfv::PackingArrays closed_layer() {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      spheres.push_back({0.125 + 0.25 * i, 0.125 + 0.25 * j, 0.5, 0.2});
  return packing_of(spheres);
}

TEST(CutOffPores, AreAtRestPinnedAndCounted) {
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 5.0, pfv::Face::zhi, 3.0, pfv::Wall::no_slip),
                 viscosity_one());
  const auto packing = closed_tetrahedron();
  const pfv::Forces& forces = flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().counts.pinned_pores, 1);
  EXPECT_TRUE(forces.total.allFinite());
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);
  // between the imposed pressures: at the reference
  EXPECT_GE(flow.pressure_at({0.5, 0.5, 0.5}), 3.0);
  EXPECT_LE(flow.pressure_at({0.5, 0.5, 0.5}), 5.0);
}

TEST(CutOffPores, WhoseVolumeChangesAreRefusedByTheirSpheres) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  auto packing = closed_tetrahedron();
  packing.velocities = packing.positions.array() - 0.5;  // outwards
  const std::string message = refusal([&] { flow.evaluate(packing.view()); });
  expect_line(message, "spheres 1, 2, 3, 4");
  expect_line(message, "(0.5, 0.5, 0.5)");
  expect_line(message, "cut off");
}

TEST(CutOffPores, ThatOnlyTravelAreAtRest) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  auto packing = closed_tetrahedron();
  packing.velocities = Eigen::Vector3d(0.3, -0.1, 0.7).replicate(1, 4);
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().counts.pinned_pores, 1);
}

TEST(CutOffPores, MayChangeTheirVolumeInACompressibleFluid) {
  pfv::Fluid fluid = viscosity_one();
  fluid.bulk_modulus = 1e3;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), fluid);
  auto packing = closed_tetrahedron();
  packing.velocities = packing.positions.array() - 0.5;
  flow.step(packing.view(), 1e-4);
  EXPECT_LT(flow.pressure_at({0.5, 0.5, 0.5}), 0.0);
  EXPECT_EQ(flow.report().counts.pinned_pores, 0);
}

TEST(ClosedLayer, LeavesNoFlowButNoErrorBetweenTwoPressures) {
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  const auto packing = closed_layer();
  const pfv::Forces& forces = flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().inflow, 0.0);
  EXPECT_EQ(flow.report().outflow, 0.0);
  EXPECT_EQ(flow.report().mass_error, 0.0);
  // all of the pressure difference pushes the layer
  EXPECT_NEAR(forces.total.row(2).sum(), 1.0, 1e-13);
}

TEST(ClosedLayer, RefusesAFluxThatCannotLeave) {
  const auto packing = closed_layer();
  pfv::Box box = upward_box(pfv::Wall::no_slip);
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  pfv::Flow whole_face(box, viscosity_one());
  expect_line(refusal([&] { whole_face.evaluate(packing.view()); }), "cut off");

  // through a patch: the cut-off set then has pores of its own beside those of the flux
  box[pfv::Face::zlo].boundary = pfv::Boundary::sealed();
  for (const double corner : {0.05, 0.65}) {
    pfv::Patch inlet;
    inlet.face = pfv::Face::zlo;
    inlet.rectangle = {corner, corner + 0.3, corner, corner + 0.3};
    inlet.boundary = pfv::Boundary::flux(1e-3);
    box.patches = {inlet};
    pfv::Flow patch(box, viscosity_one());
    expect_line(refusal([&] { patch.evaluate(packing.view()); }), "cut off");
  }
}

TEST(NoPressureAnywhere, IsZeroPressureAtRest) {
  pfv::Flow flow(pfv::Box{}, viscosity_one());
  const auto packing = random_packing(20, 0.05, 0.1, 2);
  EXPECT_TRUE(flow.evaluate(packing.view()).total.isZero(0.0));
  EXPECT_TRUE(flow.pore_pressures().isZero(0.0));
  EXPECT_EQ(flow.report().mass_error, 0.0);
}

TEST(NoPressureAnywhere, IsRefusedWithMovingGrainsFacesOrAFlux) {
  auto packing = random_packing(20, 0.05, 0.1, 2);
  const auto refused = [&](const pfv::Box& box) {
    pfv::Flow flow(box, viscosity_one());
    return refusal([&] { flow.evaluate(packing.view()); });
  };
  pfv::Box box;
  box[pfv::Face::zhi].velocity = -1.0;
  expect_line(refused(box), "nothing determines the pressure");
  box[pfv::Face::zhi].velocity = 0.0;
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1.0);
  expect_line(refused(box), "the fluid cannot leave");
  box[pfv::Face::zhi].boundary = pfv::Boundary::flux(-1.0);
  expect_line(refused(box), "its level is not determined");
  box[pfv::Face::zhi].boundary = {};
  packing.velocities = Eigen::Matrix3Xd::Constant(3, 20, 0.1);
  expect_line(refused(pfv::Box{}), "nothing determines the pressure");
}

// Also where the network is there already, whose checks are over.
TEST(FlowCalls, NameTheSphereWhoseMotionIsNotFinite) {
  auto packing = random_packing(20, 0.05, 0.1, 2);
  pfv::Options options;
  options.torques = true;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), options);
  flow.evaluate(packing.view());
  const double nan = std::nan("");
  packing.velocities = Eigen::Matrix3Xd::Zero(3, 20);
  packing.velocities(1, 4) = nan;
  expect_line(refusal([&] { flow.evaluate(packing.view()); }), "sphere 5: its velocity");
  packing.velocities(1, 4) = 0.0;
  packing.angular_velocities = packing.velocities;
  packing.angular_velocities(2, 6) = nan;
  expect_line(refusal([&] { flow.evaluate(packing.view()); }), "sphere 7: its spin");
  packing.angular_velocities.setZero();
  flow.evaluate(packing.view());
  packing.displaced_volumes = Eigen::VectorXd::Constant(20, 1e-3);
  packing.displaced_volumes[8] = nan;
  expect_line(refusal([&] { flow.evaluate(packing.view()); }), "sphere 9: its displaced volume");
}

TEST(FlowCalls, RefuseWhatTheyCannotUse) {
  const auto packing = random_packing(20, 0.05, 0.1, 2);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  expect_line(refusal([&] { flow.forces(); }), "no result");
  expect_line(refusal([&] { flow.step(packing.view(), 0.0); }), "time step");
  expect_line(refusal([&] { flow.step(packing.view(), std::nan("")); }), "time step");
  flow.evaluate(packing.view());
  expect_line(refusal([&] { flow.pressure_at({0.5, 0.5, 1.5}); }), "outside");
  expect_line(refusal([&] { flow.plane_pressure(2, 1.5); }), "cuts no pore");
  expect_line(refusal([&] { flow.plane_pressure(2, std::nan("")); }), "cuts no pore");
  expect_line(refusal([&] { flow.time_step_limit(Eigen::VectorXd::Ones(3)); }),
                       "masses");
  expect_line(refusal([&] { flow.time_step_limit(Eigen::VectorXd::Zero(20)); }),
                       "mass");
  pfv::Fluid fluid = viscosity_one();
  fluid.bulk_modulus = 1.0;
  pfv::Flow compressible(upward_box(pfv::Wall::no_slip), fluid);
  expect_line(refusal([&] { compressible.evaluate(packing.view()); }), "time step");
}

TEST(FlowCalls, HoldNoResultAfterAThrowAndRecoverFromIt) {
  auto packing = random_packing(20, 0.05, 0.1, 2);
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
  const Eigen::Matrix3Xd good = flow.evaluate(packing.view()).total;
  const double x = packing.positions(0, 4);
  packing.positions(0, 4) = std::nan("");
  expect_line(refusal([&] { flow.evaluate(packing.view()); }), "sphere 5");
  expect_line(refusal([&] { flow.forces(); }), "no result");
  packing.positions(0, 4) = x;
  EXPECT_TRUE(flow.evaluate(packing.view()).total == good);
}

TEST(BadPackings, AreRefusedBySphere) {
  const auto refused = [](const std::function<void(pfv::PackingArrays&)>& spoil) {
    auto packing = random_packing(20, 0.05, 0.1, 2);
    spoil(packing);
    pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one());
    return refusal([&] { flow.evaluate(packing.view()); });
  };
  using Arrays = pfv::PackingArrays;
  expect_line(refused([](Arrays& p) { p.radii[2] = 0.0; }), "sphere 3");
  expect_line(refused([](Arrays& p) { p.radii[2] = -1.0; }), "sphere 3");
  expect_line(refused([](Arrays& p) { p.positions(1, 6) = 1.0; }), "sphere 7");
  expect_line(refused([](Arrays& p) { p.positions(1, 6) = 1e300; }), "sphere 7");
  expect_line(refused([](Arrays& p) { p.ids[6] = 3; }), "id 3");
  expect_line(
      refused([](Arrays& p) { p.positions.col(6) = p.positions.col(1); }), "have the same centre");
  expect_line(refused([](Arrays& p) { p.radii.resize(3); }), "different lengths");
  expect_line(refused([](Arrays& p) {
    p.velocities = Eigen::Matrix3Xd::Zero(3, 20);
    p.velocities(0, 9) = std::nan("");
  }), "sphere 10");
  expect_line(refused([](Arrays& p) { p = packing_of({}); }), "no spheres");
}

/// 20 random spheres that overlap in a periodic cell: pores between them have no way out.
pfv::PackingArrays trapping_cell() {
  Random random(3);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d place = random.in_cube(0.0, 1.0);
    spheres.push_back({place[0], place[1], place[2], random(0.5, 1.5)});
  }
  pfv::PackingArrays packing = packing_of(spheres);
  packing.radii *= std::cbrt(0.6 / solid_volume(packing));
  return packing;
}

TEST(CutOffPores, OfAPeriodicCellPushAlikeWhereverTheCellIsCut) {
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {0.0, 0.0, -1.0};
  const pfv::PackingArrays packing = trapping_cell();
  pfv::Flow flow(box, viscosity_one());
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  const std::int64_t pinned = flow.report().counts.pinned_pores;
  ASSERT_GT(pinned, 0);
  ASSERT_LT(pinned, flow.report().pores / 2);
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0.3, 0.0, 0.0), {0.0, 0.0, 0.3}, {0.5, 0.5, 0.5}}) {
    pfv::PackingArrays moved = packing;
    moved.positions.colwise() += shift;
    pfv::Flow other(box, viscosity_one());
    const Eigen::Matrix3Xd found = other.evaluate(moved.view()).total;
    EXPECT_LT((found - forces).cwiseAbs().maxCoeff(), 1e-9 * forces.cwiseAbs().maxCoeff()) << shift.transpose();
    EXPECT_EQ(other.report().counts.pinned_pores, pinned);
  }
}

// Grains that yield determine the pressures of trapped pores above that of the fluid, and no level of both.
TEST(CutOffPores, OfAPeriodicCellInAnImplicitStep) {
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {0.0, 0.0, -1.0};
  pfv::PackingArrays packing = trapping_cell();
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(20);
  const Eigen::Matrix3Xd others = Eigen::Matrix3Xd::Zero(3, 20);
  const pfv::GrainDynamics dynamics{{masses.data(), 20}, {others.data(), 3, 20}};
  const auto forces = [&] {
    pfv::Flow flow(box, viscosity_one());
    const pfv::Step step = pfv::Step::with(pfv::Coupling::implicit, dynamics);
    const Eigen::Matrix3Xd found = flow.advance(packing.view(), 1e-3, step).total;
    EXPECT_LT(std::abs(flow.report().mass_error), 1e-10);
    return found;
  };
  const Eigen::Matrix3Xd here = forces();
  packing.positions.row(2).array() += 0.3;
  EXPECT_LT((forces() - here).cwiseAbs().maxCoeff(), 1e-8 * here.cwiseAbs().maxCoeff());
}

TEST(CutOffPores, HoldTheMeanPressureAroundThem) {
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 5.0, pfv::Face::zhi, 3.0, pfv::Wall::no_slip), viscosity_one());
  pfv::PackingArrays packing = closed_tetrahedron();
  packing.positions.row(2).array() += 0.15;  // nearer to the lower pressure
  flow.evaluate(packing.view());
  ASSERT_EQ(flow.report().counts.pinned_pores, 1);
  const pfv::PoreNetwork& network = flow.network();
  const int pore = [&] {
    for (int p = 0; p < network.pores(); ++p)
      if ((network.origin + network.pore_centres.col(p) - Eigen::Vector3d(0.5, 0.5, 0.65)).norm() < 1e-6) return p;
    return -1;
  }();
  ASSERT_GE(pore, 0);
  double sum = 0.0;
  int count = 0;  // the four facets are alike
  for (const auto& [i, j] : network.throat_pores)
    if (i == pore || j == pore) {
      sum += flow.pore_pressures()[i == pore ? j : i];
      ++count;
    }
  ASSERT_EQ(count, 4);
  EXPECT_NEAR(flow.pore_pressures()[pore], sum / 4.0, 1e-9);
  EXPECT_LT(flow.pore_pressures()[pore], 3.99);
}

TEST(Sizes, WhosePowersAreNoNumbersAreRefused) {
  for (const double edge : {1e100, 1e-150}) {
    pfv::Box box = upward_box(pfv::Wall::no_slip);
    box.upper = {edge, edge, edge};
    expect_line(refusal([&] { pfv::Flow flow(box, viscosity_one()); }), "give one between 1e-30 and 1e30 m");
  }
}

}  // namespace
}  // namespace flow_errors_test
