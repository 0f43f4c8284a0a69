// SPDX-License-Identifier: GPL-3.0-or-later
// The coarse-grid Darcy model: porosity, flow, drag, and what it refuses.
#include "pfv/darcy_grid.hpp"

#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace darcy_grid_test {
namespace {

using pfv::Boundary;
using pfv::DarcyGrid;
using pfv::DarcyOptions;
using pfv::DragLaw;
using pfv::Face;
using pfv::Wall;
using support::pi;

DarcyOptions grid_of(int nx, int ny, int nz, DragLaw drag = DragLaw::kozeny_carman) {
  DarcyOptions grid;
  grid.cells = {nx, ny, nz};
  grid.drag = drag;
  return grid;
}

/// Touching spheres of diameter 1/n: porosity 1 - pi/6 in every cell of a grid that divides n.
pfv::PackingArrays cubic(int n) { return support::lattice(support::Lattice::sc, n); }

double cubic_permeability(int n) {
  const double e = 1.0 - pi / 6.0, d = 1.0 / n;
  return e * e * e * d * d / (180.0 * (1.0 - e) * (1.0 - e));
}

pfv::PackingArrays moving(pfv::PackingArrays packing,
                          const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& velocity) {
  packing.velocities.resize(3, packing.positions.cols());
  for (Eigen::Index k = 0; k < packing.positions.cols(); ++k)
    packing.velocities.col(k) = velocity(packing.positions.col(k));
  return packing;
}

TEST(DarcyGrid, ALookIsAtGrainsAndFacesAsTheyAre) {
  pfv::PackingArrays packing = support::random_packing(60, 0.02, 0.2, 7);
  pfv::Box box = support::upward_box(Wall::symmetry);
  DarcyOptions grid = grid_of(3, 3, 3);
  grid.refresh_every = 100;
  DarcyGrid flow(box, support::viscosity_one(), grid);
  const auto expect_as_new = [&] {
    DarcyGrid fresh(box, support::viscosity_one(), grid);
    fresh.evaluate(packing.view());
    flow.evaluate(packing.view());
    EXPECT_TRUE(flow.cell_porosities() == fresh.cell_porosities());
  };
  expect_as_new();
  packing.positions.row(0) *= 0.9;
  expect_as_new();
  packing.radii *= 0.8;
  expect_as_new();
  box.upper[2] = 1.2;
  flow.set_box(box);
  expect_as_new();
  EXPECT_EQ(flow.retriangulations(), 3);
}

TEST(DarcyGrid, PorositiesAddUpToTheExactTotal) {
  const pfv::PackingArrays packing = support::random_packing(60, 0.02, 0.2, 7);
  const double solid = support::solid_volume(packing);
  for (const auto& cells : {std::array<int, 3>{1, 1, 1}, {3, 5, 2}, {17, 16, 13}}) {
    DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(),
                   grid_of(cells[0], cells[1], cells[2]));
    flow.evaluate(packing.view());
    const double volume = flow.cell_lengths().prod();
    const double found = (1.0 - flow.cell_porosities().array()).sum() * volume;
    EXPECT_NEAR(found, solid, 1e-13 * solid);
    EXPECT_NEAR(flow.report().porosity, 1.0 - solid, 1e-13);
    EXPECT_NEAR(flow.report().solid_area / support::solid_surface(packing), 1.0, 1e-12);
    // rounding is 1e-15 of a ball, of which some are a hundred cells
    EXPECT_GE(flow.cell_porosities().minCoeff(), -1e-13);
    EXPECT_LE(flow.cell_porosities().maxCoeff(), 1.0);
  }
}

TEST(DarcyGrid, SpheresThatOverlapCountTwiceAndThoseAcrossAFaceByTheirPartInside) {
  const auto packing = support::packing_of({{0.5, 0.5, 0.5, 0.2}, {0.6, 0.5, 0.5, 0.2},
                                            {1.0 - 1e-9, 0.5, 0.5, 0.1}});
  DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(), grid_of(4, 3, 5));
  flow.evaluate(packing.view());
  const double ball = 4.0 / 3.0 * pi;
  const double solid = 2.0 * ball * 0.008 + 0.5 * ball * 0.001;
  EXPECT_NEAR(flow.report().porosity, 1.0 - solid, 1e-10);  // the third lies 1e-9 within the face
}

TEST(DarcyGrid, PermeabilityIsKozenyCarmansUpToItsCap) {
  DarcyGrid dense(support::upward_box(Wall::symmetry), support::viscosity_one(), grid_of(2, 3, 6));
  dense.evaluate(cubic(6).view());
  for (const double k : dense.cell_permeabilities())
    EXPECT_NEAR(k / cubic_permeability(6), 1.0, 1e-12);
  EXPECT_NEAR(*dense.report().permeability / cubic_permeability(6), 1.0, 1e-12);

  DarcyGrid loose(support::upward_box(Wall::symmetry), support::viscosity_one(), grid_of(1, 1, 1));
  loose.evaluate(support::lattice(support::Lattice::sc, 4, 0.5).view());
  EXPECT_GT(loose.cell_porosities()[0], 0.9);
  const double capped = 0.343 * 0.125 * 0.125 / (180.0 * 0.09);
  EXPECT_NEAR(loose.cell_permeabilities()[0] / capped, 1.0, 1e-12);
}

TEST(DarcyGrid, UniformFlowIsExact) {
  pfv::Fluid fluid;
  fluid.viscosity = 0.2;
  DarcyGrid flow(support::upward_box(Wall::symmetry), fluid, grid_of(2, 4, 8));
  flow.evaluate(cubic(8).view());
  const double discharge = cubic_permeability(8) / fluid.viscosity;  // dp/L = 1
  const Eigen::Matrix3Xd velocities = flow.cell_velocities();
  for (const auto& velocity : velocities.colwise())
    EXPECT_LT((velocity - Eigen::Vector3d(0.0, 0.0, discharge)).norm(), 1e-12 * discharge);
  EXPECT_NEAR(flow.faces()[4].flux / discharge, 1.0, 1e-12);
  EXPECT_NEAR(flow.pressure_at({0.3, 0.9, 0.37}), 0.63, 1e-12);
  EXPECT_NEAR(flow.plane_pressure(2, 0.37), 0.63, 1e-12);
  EXPECT_NEAR(flow.mean_pressure(), 0.5, 1e-12);
}

TEST(DarcyGrid, ErrorOfALinearProblemFallsWithTheSquareOfTheCells) {
  // p = cos(pi x) cosh(pi z)/cosh(pi): harmonic, no flow through the sides and the base
  pfv::Box box;
  box[Face::zhi].boundary.kind = Boundary::Kind::pressure;
  box[Face::zhi].boundary.profile = [](const Eigen::Vector3d& x, double) {
    return std::cos(pi * x[0]);
  };
  const pfv::PackingArrays packing = cubic(32);
  std::vector<double> errors;
  for (const int n : {8, 16, 32}) {
    DarcyGrid flow(box, support::viscosity_one(), grid_of(n, 1, n));
    flow.evaluate(packing.view());
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        const double x = (i + 0.5) / n, z = (k + 0.5) / n;
        const double exact = std::cos(pi * x) * std::cosh(pi * z) / std::cosh(pi);
        sum += std::pow(flow.cell_pressures()[i + n * k] - exact, 2);
      }
    errors.push_back(std::sqrt(sum) / n);
    EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);
  }
  // measured 3.7e-3, 9.9e-4, 2.5e-4: orders 1.91 and 1.98
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.15);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.05);
}

TEST(DarcyGrid, LayersResistInSeries) {
  // half of the cells with spheres of half the size: another porosity, the same mean diameter
  std::vector<support::Sphere> spheres;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector3d x = (Eigen::Array3d(i, j, k) + 0.5).matrix() / 4.0;
        spheres.push_back({x[0], x[1], x[2], k < 2 ? 0.125 : 0.11});
      }
  DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(), grid_of(4, 2, 4));
  flow.evaluate(support::packing_of(spheres).view());
  const auto& k = flow.cell_permeabilities();
  const double low = k[0], high = k[k.size() - 1];
  EXPECT_GT(high, 1.5 * low);
  EXPECT_NEAR(*flow.report().permeability * 0.5 * (1.0 / low + 1.0 / high), 1.0, 1e-12);
}

TEST(DarcyGrid, InflowIsOutflowThroughAPatch) {
  const pfv::PackingArrays packing = support::random_packing(150, 0.05, 0.12, 3);
  pfv::Box box;
  box[Face::ylo].boundary = Boundary::flux(1e-5);
  box.patches.push_back({Face::yhi, {0.4, 0.6, 0.4, 0.6}, Boundary::pressure(1e5)});
  DarcyGrid flow(box, pfv::Fluid{}, grid_of(10, 10, 10));
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  EXPECT_NEAR(report.inflow / 1e-5, 1.0, 1e-14);
  EXPECT_LT(std::abs(report.mass_error), 1e-11);  // measured 4e-14
  EXPECT_LT(report.residual, 1e-12);
  // the flux is even over its face
  for (int i = 0; i < 10; ++i) {
    const double entering = flow.cell_velocities()(1, i);
    EXPECT_GT(entering, 0.0);
  }
}

TEST(DarcyGrid, APatchBetweenTheCellsTakesTheNearest) {
  pfv::Box box;
  box[Face::zlo].boundary = Boundary::flux(1.0);
  box.patches.push_back({Face::zhi, {0.55, 0.56, 0.2, 0.21}, Boundary::pressure(0.0)});
  DarcyGrid flow(box, support::viscosity_one(), grid_of(4, 4, 2));
  flow.evaluate(cubic(4).view());
  EXPECT_NEAR(flow.faces()[5].flux, -1.0, 1e-12);
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);
}

TEST(DarcyGrid, DragAndGradientOfAUniformBedCarryTheWholePressureDrop) {
  const pfv::PackingArrays packing = cubic(6);
  pfv::Options options;
  options.split_forces = true;
  DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(), grid_of(3, 2, 3),
                 options);
  const pfv::Forces& forces = flow.evaluate(packing.view());
  const double share = 1.0 / 216.0, solid = pi / 6.0;  // of the force dp S = 1
  for (Eigen::Index k = 0; k < 216; ++k) {
    EXPECT_NEAR(forces.total(2, k), share, 1e-14);
    EXPECT_NEAR(forces.pressure(2, k), share * solid, 1e-14);
    EXPECT_NEAR(forces.viscous(2, k), share * (1.0 - solid), 1e-14);
    EXPECT_LT(forces.total.col(k).head<2>().norm(), 1e-14);
  }
  EXPECT_LT(flow.report().force_balance_error, 1e-13);
}

TEST(DarcyGrid, KozenyCarmanDragBalancesAnyFlow) {
  const pfv::PackingArrays packing =
      moving(support::random_packing(400, 0.04, 0.08, 5), [](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(x[1], -x[0], 0.1 - x[2] * x[0]);
      });
  pfv::Box box = support::pressure_box(Face::xlo, 3.0, Face::yhi, 1e4, Wall::symmetry);
  box[Face::zhi].velocity = -0.01;
  DarcyGrid flow(box, support::viscosity_one(), grid_of(2, 2, 2));
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  EXPECT_LT(report.force_balance_error, 1e-13);
  EXPECT_NEAR(report.volume_rate_sum, -0.01, 1e-15);
  EXPECT_LT(std::abs(report.mass_error), 1e-12);
}

TEST(DarcyGrid, DiFeliceDragIsThatOfItsFormula) {
  // spheres of 1.25 mm touching in cells of 1 cm, water, a discharge in the inertial range
  const double r = 1.25e-3, U = 0.01, e = 1.0 - pi / 6.0;
  pfv::PackingArrays packing = cubic(8);
  packing.positions *= 0.02;
  packing.radii *= 0.02;
  pfv::Box box;
  box.upper = Eigen::Vector3d::Constant(0.02);
  box[Face::xlo].boundary = Boundary::flux(U * 4e-4);
  box[Face::xhi].boundary = Boundary::pressure(0.0);
  pfv::Fluid water;
  water.viscosity = 1.004e-3;
  water.density = 998.23;
  pfv::Options options;
  options.split_forces = true;
  DarcyGrid flow(box, water, grid_of(2, 2, 2, DragLaw::di_felice), options);
  const pfv::Forces& forces = flow.evaluate(packing.view());
  const double Re = 2.0 * water.density * r * U / water.viscosity;
  const double C = std::pow(0.63 + 4.8 / std::sqrt(Re), 2);
  const double chi = 3.7 - 0.65 * std::exp(-std::pow(1.5 - std::log10(Re), 2) / 2.0);
  const double drag = 0.5 * C * water.density * pi * r * r * U * U * std::pow(e, -chi);
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k)
    EXPECT_NEAR(forces.viscous(0, k) / drag, 1.0, 1e-12);
}

TEST(DarcyGrid, DiFeliceDragIsLinearAndFiniteInCreepingFlowAndAtRest) {
  pfv::Options options;
  options.split_forces = true;
  DarcyGrid still(pfv::Box{}, support::viscosity_one(), grid_of(2, 2, 2, DragLaw::di_felice),
                  options);
  EXPECT_EQ(still.evaluate(cubic(4).view()).total.norm(), 0.0);

  pfv::Fluid oil = support::viscosity_one();
  oil.density = 1e-12;
  DarcyGrid slow(support::upward_box(Wall::symmetry), oil, grid_of(2, 2, 2, DragLaw::di_felice),
                 options);
  const pfv::Forces& forces = slow.evaluate(cubic(4).view());
  const double U = cubic_permeability(4), e = 1.0 - pi / 6.0;  // C_d Re -> 4.8²
  const double stokes = 0.25 * 23.04 * pi * 0.125 * U * std::pow(e, -3.7);
  EXPECT_NEAR(forces.viscous(2, 0) / stokes, 1.0, 1e-6);
}

TEST(DarcyGrid, ASqueezedBedDrainsAsDarcySays) {
  // v_z = -w z below a lid that sinks with w, drained on top: mu w H²/(2 K) at the base
  const double w = 0.01;
  pfv::Box box;
  box[Face::zhi].boundary = Boundary::pressure(0.0);
  box[Face::zhi].velocity = -w;
  const pfv::PackingArrays packing =
      moving(cubic(16), [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(0, 0, -w * x[2]); });
  DarcyGrid flow(box, support::viscosity_one(), grid_of(1, 1, 16));
  flow.evaluate(packing.view());
  const double base = w / (2.0 * cubic_permeability(16));
  EXPECT_NEAR(flow.cell_pressures()[0] / base, 1.0, 4e-3);  // (z/H)², z = 1/32, and (h/H)²/4
  EXPECT_NEAR(-flow.faces()[5].flux / w, 1.0, 1e-12);
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-12);

  DarcyOptions steady = grid_of(1, 1, 16);
  steady.grain_motion = false;  // as in the example: grains move in a flow that does not know it
  DarcyGrid unmoved(box, support::viscosity_one(), steady);
  unmoved.evaluate(packing.view());
  EXPECT_EQ(unmoved.cell_pressures().norm(), 0.0);
}

TEST(DarcyGrid, GrainsThatMoveWithTheFluidFeelNoDrag) {
  // the whole box moves along x with its faces: nothing flows past anything
  pfv::Box box = support::pressure_box(Face::xlo, 0.0, Face::xhi, 0.0, Wall::symmetry);
  box[Face::xlo].velocity = box[Face::xhi].velocity = 0.3;
  const pfv::PackingArrays packing = moving(
      cubic(4), [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.3, 0.0, 0.0); });
  DarcyGrid flow(box, support::viscosity_one(), grid_of(2, 2, 2, DragLaw::di_felice));
  const double scale = 0.3 / cubic_permeability(4);  // of the drag on grains in fluid at rest
  EXPECT_LT(flow.evaluate(packing.view()).total.cwiseAbs().maxCoeff(), 1e-14 * scale);
}

TEST(DarcyGrid, TimeStepLimitIsThatOfTheDragAlone) {
  // without grain motion each grain has its own: 2 m / (zeta e V)
  DarcyOptions steady = grid_of(2, 2, 2);
  steady.grain_motion = false;
  DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(), steady);
  const pfv::PackingArrays packing = cubic(4);
  flow.evaluate(packing.view());
  const Eigen::VectorXd masses = Eigen::VectorXd::Constant(64, 2.0);
  const double e = 1.0 - pi / 6.0, volume = pi / 6.0 / 64.0;
  const double drag = e / (cubic_permeability(4) * (1.0 - e)) * e * volume;
  // the iteration's result is raised by 3 %
  EXPECT_NEAR(flow.time_step_limit(masses) * 1.03 / (4.0 / drag), 1.0, 1e-3);
}

TEST(DarcyGrid, ALightPistonLowersTheTimeStepLimit) {
  // over a column that drains at its base: what the piston pushes out of the uppermost cell flows
  // from its centre on, so that the force is w (H - h/2) mu/K a unit area
  pfv::Box box;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  DarcyGrid flow(box, support::viscosity_one(), grid_of(1, 1, 8));
  flow.evaluate(cubic(8).view());
  const double infinite = std::numeric_limits<double>::infinity(), mass = 1e-6;
  std::vector<pfv::Piston> pistons = std::vector<pfv::Piston>(6);
  pistons[5].mass = mass;
  const double limit = flow.time_step_limit(Eigen::VectorXd::Constant(512, infinite), pistons);
  EXPECT_NEAR(limit * 1.03 / (2.0 * mass * cubic_permeability(8) / (1.0 - 1.0 / 16)), 1.0, 1e-3);
}

TEST(DarcyGrid, ThePorosityIsLookedAtEveryNSteps) {
  DarcyOptions grid = grid_of(2, 2, 2);
  grid.refresh_every = 3;
  DarcyGrid flow(support::upward_box(Wall::symmetry), support::viscosity_one(), grid);
  pfv::PackingArrays packing = cubic(4);
  for (int step = 0; step < 7; ++step) flow.step(packing.view(), 0.1);
  EXPECT_EQ(flow.retriangulations(), 2);
  EXPECT_EQ(flow.report().counts.order, 1);
  EXPECT_EQ(flow.report().counts.factor, 3);
  EXPECT_EQ(flow.report().counts.solve, 3);  // nothing changed in between
  EXPECT_NEAR(flow.time(), 0.7, 1e-15);
  packing.positions.col(5).x() = 2.0;  // it has left the box
  EXPECT_THROW(flow.step(packing.view(), 0.1), pfv::InputError);
}

TEST(DarcyGrid, GravityGivesBuoyancyOnce) {
  pfv::Fluid water;
  water.gravity = {0.0, 0.0, -10.0};
  DarcyGrid flow(pfv::Box{}, water, grid_of(2, 2, 2));
  const pfv::Forces& forces = flow.evaluate(cubic(2).view());
  EXPECT_NEAR(forces.total(2, 3) / (1e4 * pi / 6.0 / 8.0), 1.0, 1e-14);
}

TEST(DarcyGrid, SameInputSameBytes) {
  const pfv::PackingArrays packing = support::random_packing(200, 0.04, 0.09, 8);
  const auto forces = [&] {
    DarcyGrid flow(support::upward_box(Wall::symmetry), pfv::Fluid{}, grid_of(4, 4, 4));
    return flow.evaluate(packing.view()).total;
  };
  EXPECT_EQ(forces(), forces());
}

TEST(DarcyGrid, RefusesWhatItCannotUse) {
  const auto refusal = [](const pfv::Box& box, const pfv::Fluid& fluid, const DarcyOptions& grid,
                          const pfv::Options& options) {
    return support::refusal([&] {
      DarcyGrid flow(box, fluid, grid, options);
      flow.evaluate(cubic(2).view());
    });
  };
  using support::expect_line;
  pfv::Fluid compressible;
  compressible.bulk_modulus = 1e9;
  expect_line(refusal({}, compressible, grid_of(1, 1, 1), {}), "no bulk modulus");
  pfv::Box periodic;
  periodic.periodic[0] = true;
  expect_line(refusal(periodic, {}, grid_of(1, 1, 1), {}), "no periodic axes");
  pfv::Options yade;
  yade.partition = pfv::Partition::yade;
  yade.conductance = pfv::ConductanceLaw::hydraulic_radius;  // YADE's
  yade.volume_rates = pfv::VolumeRates::geometric;
  expect_line(refusal({}, {}, grid_of(1, 1, 1), yade), "no partition");
  expect_line(refusal({}, {}, grid_of(1, 0, 1), {}), "whole number >= 1");
  expect_line(refusal({}, {}, grid_of(2000, 2000, 2000), {}), "too many");
  pfv::Box fed;
  fed[Face::xlo].boundary = Boundary::flux(1.0);
  expect_line(refusal(fed, {}, grid_of(1, 1, 1), {}), "nothing determines the pressure");
  fed[Face::xhi].boundary = Boundary::pressure(0.0);
  fed.patches.push_back({Face::xlo, {-1.0, 2.0, -1.0, 2.0}, Boundary::sealed()});
  expect_line(refusal(fed, {}, grid_of(2, 2, 2), {}), "has no cell to enter");
  DarcyGrid fresh(pfv::Box{}, pfv::Fluid{}, grid_of(1, 1, 1));
  expect_line(support::refusal([&] { fresh.report(); }), "holds no result");
}

}  // namespace
}  // namespace darcy_grid_test
