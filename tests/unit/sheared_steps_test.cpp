// SPDX-License-Identifier: GPL-3.0-or-later
// Long steps of grains that shear the fluid between them: staged and implicit, beside small explicit ones.
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "physics/shear_forces.hpp"
#include "support/boxes.hpp"
#include "support/long_steps.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace sheared_steps_test {
namespace {

using namespace support;
using pfv::Coupling;
using pfv::Face;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double theta = 2.0 / 3.0;  // of ImplicitStep

pfv::Box drained() { return pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, pfv::Wall::symmetry); }

pfv::Options options(bool shear, bool torques = false) {
  pfv::Options options;
  options.shear_viscous = shear;
  options.torques = torques;
  return options;
}

/// Grains that touch nothing, moved by the fluid and by what `others` says; the network stays.
struct Grains {
  pfv::PackingArrays packing;
  Eigen::VectorXd masses = 2600.0 * 4.0 / 3.0 * pi * packing.radii.array().cube();
  Eigen::Matrix3Xd others = Eigen::Matrix3Xd::Zero(3, masses.size());
  std::vector<pfv::Piston> pistons = std::vector<pfv::Piston>(6);
  pfv::Box box;
  pfv::Fluid fluid;
  pfv::Options by;
  pfv::Flow flow;

  Grains(pfv::PackingArrays of, const pfv::Options& with, const pfv::Box& in = drained(),
         const pfv::Fluid& made = viscosity_one())
      : packing(std::move(of)), box(in), fluid(made), by(with), flow(in, made, with) {
    Random random(1);
    packing.velocities.resize(3, masses.size());
    for (int k = 0; k < masses.size(); ++k) packing.velocities.col(k) = 1e-9 * random.in_cube();
    packing.angular_velocities = others;
  }
  pfv::GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {others.data(), 3, others.cols()}, pistons};
  }
  double limit() {
    flow.evaluate(packing.view(), 1.0);
    return flow.time_step_limit(masses, pistons);
  }
  const pfv::Forces& advance(Coupling coupling, double dt) {
    if (coupling == Coupling::explicit_step) return flow.step(packing.view(), dt);
    return flow.advance(packing.view(), dt, pfv::Step::with(coupling, dynamics()));
  }
  /// What the host makes of the forces, or `part` of the way there.
  void move(const pfv::Forces& forces, double dt) {
    packing.velocities.array() +=
        dt * ((forces.total + others).array().rowwise() / masses.transpose().array());
    if (!by.torques) return;
    const Eigen::ArrayXd inertias = 0.4 * masses.array() * packing.radii.array().square();
    packing.angular_velocities.array() += dt * (forces.torque.array().rowwise() / inertias.transpose());
  }
  void take(Coupling coupling, double dt, int steps) {
    for (int step = 0; step < steps; ++step) move(advance(coupling, dt), dt);
  }
  double energy() const {
    const Eigen::ArrayXd squares =
        packing.velocities.colwise().squaredNorm().transpose().array() +
        0.4 * packing.radii.array().square() * packing.angular_velocities.colwise().squaredNorm().transpose().array();
    return (masses.array() * squares).sum();
  }
};

/// d_max / d_min of 1.2, dense; 3 and 10, loose.
pfv::PackingArrays of_size_ratio(double ratio) {
  if (ratio < 1.5) return pfv::dense_packing(100, 0.6, 0.09);
  return random_packing(ratio < 5.0 ? 120 : 200, 0.12 / ratio, 0.12, 3);
}

// stability

TEST(ShearedSteps, FeedNoMotionAtAnySizeRatioHoweverLongTheyAre) {
  struct Case {
    Coupling coupling;
    double ratio;
    int steps;
  };
  const Case cases[]{{Coupling::staged, 10.0, 10},    {Coupling::staged, 100.0, 8},    {Coupling::staged, 1000.0, 5},
                     {Coupling::staged, 1e4, 3},      {Coupling::implicit, 10.0, 10},  {Coupling::implicit, 100.0, 10},
                     {Coupling::implicit, 1000.0, 10}, {Coupling::implicit, 1e4, 10}, {Coupling::implicit, 1e5, 10}};
  for (const double sizes : {1.2, 3.0, 10.0})
    for (const bool torques : {false, true}) {
      const double limit = Grains(of_size_ratio(sizes), options(true, torques)).limit();
      for (const auto& [coupling, ratio, steps] : cases) {
        Grains run(of_size_ratio(sizes), options(true, torques));
        const double dt = ratio * limit, start = run.energy();
        double last = start;
        for (int step = 0; step < steps; ++step) {
          run.move(run.advance(coupling, dt), dt);
          // what all grains do together in a frictionless box is not braked
          EXPECT_LE(run.energy(), last * (1.0 + 1e-12)) << sizes << ' ' << torques << ' ' << ratio << ' ' << step;
          last = run.energy();
        }
        EXPECT_LT(last, 0.4 * start) << sizes << ' ' << torques << ' ' << ratio;
      }
    }
}

TEST(ShearedSteps, TheLimitThatIsSaidIsThatOfTheExplicitStep) {
  for (const double sizes : {1.2, 10.0}) {
    Grains below(of_size_ratio(sizes), options(true)), above(of_size_ratio(sizes), options(true));
    const double limit = below.limit(), start = below.energy();
    EXPECT_LT(limit, Grains(of_size_ratio(sizes), options(false)).limit());
    below.take(Coupling::explicit_step, 0.98 * limit, 300);
    for (int step = 0; step < 300 && above.energy() <= 1e3 * start; ++step)
      above.take(Coupling::explicit_step, 1.1 * limit, 1);
    EXPECT_LT(below.energy(), start) << sizes;
    EXPECT_GT(above.energy(), 1e3 * start) << sizes;
  }
}

// what is solved

/// The forces of an implicit step against those of the velocities that they belong to.
void expect_forces_of_their_own_velocities(Grains& run, double dt, const std::string& what) {
  Grains steady(run.packing, run.by, run.box, run.fluid);
  steady.packing = run.packing;
  steady.flow.set_state(run.flow.state());
  const pfv::Forces forces = run.advance(Coupling::implicit, dt);
  const pfv::Report report = run.flow.report();
  EXPECT_LT(std::abs(report.mass_error), 1e-10) << what;
  EXPECT_LT(report.force_balance_error, 1e-12) << what;
  EXPECT_LT(report.residual, 1e-10) << what;
  steady.others = run.others;
  steady.masses = run.masses;
  steady.move(forces, theta * dt);
  const pfv::Forces expected = steady.flow.evaluate(steady.packing.view(), dt);
  EXPECT_LT((forces.total - expected.total).norm(), 1e-9 * expected.total.norm()) << what;
  if (run.by.torques) {
    EXPECT_LT((forces.torque - expected.torque).norm(), 1e-9 * expected.torque.norm()) << what;
  }
}

TEST(ShearedSteps, ImplicitForcesAreThoseOfVelocitiesBetweenThoseTakenAndThoseHandedBack) {
  pfv::Box through = drained();
  through[Face::zlo].boundary = pfv::Boundary::pressure(1e5);
  through[Face::zhi].boundary = pfv::Boundary::pressure(1e5 + 10.0);
  through[Face::xhi].velocity = 3e-10;
  for (const auto& box : {drained(), through})
    for (const double bulk_modulus : {0.0, 1e4})
      for (const bool torques : {false, true})
        for (const double ratio : {10.0, 1000.0}) {
          pfv::Fluid fluid = viscosity_one();
          if (bulk_modulus > 0.0) fluid.bulk_modulus = bulk_modulus;
          Grains run(data_packing("packing_100.csv"), options(true, torques), box, fluid);
          run.others.setConstant(3e-9);
          run.masses.head(5).setConstant(infinite);
          expect_forces_of_their_own_velocities(run, ratio * run.limit(),
                                                std::to_string(ratio) + ' ' + std::to_string(bulk_modulus));
        }
}

/// Four spheres around a pore without a way out: its pressure is what keeps its volume.
TEST(ShearedSteps, APoreThatGrainsAloneCloseIsDeterminedByThem) {
  for (const bool shear : {false, true}) {
    pfv::PackingArrays packing = packing_of({{0.5 + 0.18, 0.5 + 0.18, 0.5 + 0.18, 0.3},
                                             {0.5 + 0.18, 0.5 - 0.18, 0.5 - 0.18, 0.3},
                                             {0.5 - 0.18, 0.5 + 0.18, 0.5 - 0.18, 0.3},
                                             {0.5 - 0.18, 0.5 - 0.18, 0.5 + 0.18, 0.3}});
    Grains run(packing, options(shear), upward_box(pfv::Wall::no_slip));
    run.packing.velocities.setZero();
    run.limit();
    ASSERT_EQ(run.flow.report().counts.pinned_pores, 1);
    run.packing.velocities = 1e-9 * (packing.positions.array() - 0.5);  // outwards
    const double dt = 1.0;
    const Eigen::Matrix3Xd forces = run.advance(Coupling::implicit, dt).total;
    EXPECT_LT(std::abs(run.flow.report().mass_error), 1e-10);
    EXPECT_TRUE(forces.allFinite());
    // the velocities that they belong to leave the pore its volume
    const Eigen::Matrix3Xd between =
        run.packing.velocities +
        Eigen::Matrix3Xd(theta * dt * (forces.array().rowwise() / run.masses.transpose().array()));
    const Eigen::Matrix3Xd outwards = packing.positions.array() - 0.5;
    EXPECT_LT(std::abs(between.cwiseProduct(outwards).sum()), 1e-9 * run.packing.velocities.norm()) << shear;
  }
}

TEST(ShearedSteps, OneSolveAStepAndOneFactorUntilAMassOrTheStepChanges) {
  Grains run(data_packing("packing_100.csv"), options(true));
  const double dt = 10.0 * run.limit();
  const auto step = [&](double by) { run.advance(Coupling::implicit, by); };
  step(dt);
  const pfv::Counts first = run.flow.report().counts;
  for (int k = 0; k < 5; ++k) step(dt);
  EXPECT_EQ(run.flow.report().counts.solve, first.solve + 5);
  EXPECT_EQ(run.flow.report().counts.factor, first.factor);
  step(0.5 * dt);
  EXPECT_EQ(run.flow.report().counts.factor, first.factor + 1);
  EXPECT_EQ(run.flow.report().counts.order, first.order);
  run.masses[0] = infinite;
  step(0.5 * dt);
  EXPECT_EQ(run.flow.report().counts.order, first.order + 1);
}

TEST(ShearedSteps, NoByteDependsOnTheThreads) {
  for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
    std::vector<Eigen::Matrix3Xd> velocities;
    for (const int threads : {1, 3}) {
      pfv::Options by = options(true, true);
      by.threads = threads;
      Grains run(data_packing("packing_500.csv"), by);
      run.take(coupling, 50.0 * run.limit(), 3);
      velocities.push_back(run.packing.velocities);
    }
    EXPECT_EQ(velocities[0], velocities[1]);
  }
}

TEST(ShearedSteps, AStoredStateGoesOnWithTheSameBytes) {
  for (const Coupling coupling : {Coupling::staged, Coupling::implicit})
    for (const double bulk_modulus : {0.0, 1e4}) {
      pfv::Fluid fluid = viscosity_one();
      if (bulk_modulus > 0.0) fluid.bulk_modulus = bulk_modulus;
      Grains whole(data_packing("packing_100.csv"), options(true), drained(), fluid);
      const double dt = 100.0 * whole.limit();
      whole.take(coupling, dt, 3);
      Grains rest(whole.packing, options(true), drained(), fluid);
      rest.packing = whole.packing;  // the velocities, too
      rest.flow.set_state(whole.flow.state());
      whole.take(coupling, dt, 3);
      rest.take(coupling, dt, 3);
      EXPECT_EQ(whole.packing.velocities, rest.packing.velocities);
    }
}

// accuracy

TEST(ShearedSteps, ErrAsLongStepsWithoutShearDo) {
  // grains that begin to fall, after 80 limits of time: the velocities that long steps give
  for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
    std::vector<double> errors;
    for (const bool shear : {false, true}) {
      const auto velocities = [&](Coupling by, double ratio) {
        Grains run(data_packing("packing_100.csv"), options(shear));
        run.packing.velocities.setZero();
        for (int k = 0; k < run.masses.size(); ++k)
          run.others(2, k) = -1e-9 * run.masses[k] * (k % 3);  // not alike, so that they slide
        run.take(by, ratio * run.limit(), static_cast<int>(std::lround(80.0 / ratio)));
        return run.packing.velocities;
      };
      const Eigen::Matrix3Xd fine = velocities(Coupling::explicit_step, 0.25);
      errors.push_back((velocities(coupling, 20.0) - fine).norm() / fine.norm());
    }
    EXPECT_LT(errors[1], 1.5 * errors[0]);
    EXPECT_LT(errors[1], 0.05);
  }
}

TEST(ShearedSteps, ImplicitOnesAreOfFirstOrderWithAThirdOfTheErrorOfExplicitOnes) {
  const auto velocities = [](double ratio, Coupling coupling) {
    Grains run(data_packing("packing_100.csv"), options(true));
    run.take(coupling, ratio * run.limit(), static_cast<int>(std::lround(4.0 / ratio)));
    return run.packing.velocities;
  };
  const Eigen::Matrix3Xd exact = 2.0 * velocities(1.0 / 512, Coupling::explicit_step) -
                                 velocities(1.0 / 256, Coupling::explicit_step);
  const auto error = [&](double ratio, Coupling coupling) {
    return (velocities(ratio, coupling) - exact).norm() / exact.norm();
  };
  const double coarse = error(1.0 / 8, Coupling::implicit), half = error(1.0 / 16, Coupling::implicit);
  EXPECT_NEAR(coarse / half, 2.0, 0.15);
  EXPECT_NEAR(half / error(1.0 / 16, Coupling::explicit_step), 1.0 / 3.0, 0.03);  // theta - 1/2 against 1/2
}

TEST(ShearedSteps, ComeToRestWhereDragAndShearBearTheLoad) {
  // some grains are held, the others and a lid settle between them at the velocity that belongs to their load
  pfv::Box box = drained();
  box[Face::zhi].boundary = pfv::Boundary::sealed();
  for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
    Grains run(data_packing("packing_100.csv"), options(true), box);
    run.packing.velocities.setZero();
    run.others.row(2) = -1e-9 * run.masses.transpose();
    for (int k = 0; k < run.masses.size(); k += 4) run.masses[k] = infinite;
    const double load = -1e-6, mass = 100.0;
    run.pistons[5] = {mass, load};
    const double dt = (coupling == Coupling::staged ? 1e4 : 1e5) * run.limit();
    double velocity = 0.0, force = 0.0;
    Eigen::Matrix3Xd on_grains;
    for (int step = 0; step < 40; ++step) {
      box[Face::zhi].velocity = velocity;
      run.flow.set_box(box);
      const pfv::Forces& forces = run.advance(coupling, dt);
      const pfv::FaceResult& lid = run.flow.faces()[static_cast<int>(Face::zhi)];
      force = (lid.force_pressure + lid.force_viscous)[2];
      on_grains = forces.total;
      run.move(forces, dt);
      velocity += dt / mass * (load + force);
    }
    EXPECT_NEAR(force / load, -1.0, 1e-6);
    for (int k = 0; k < run.masses.size(); ++k)
      if (std::isfinite(run.masses[k])) {
        EXPECT_LT((on_grains.col(k) + run.others.col(k)).norm(), 1e-6 * std::abs(load)) << k;
      }
    EXPECT_GT(run.packing.velocities.norm(), 0.0);
  }
}

// what chooses

TEST(ShearedSteps, AutomaticCouplingIsImplicitFarBeyondTheLimitWhereTheSolverCan) {
  for (const auto& [solver, wanted] : {std::pair{pfv::SolverKind::automatic, Coupling::implicit},
                                       std::pair{pfv::SolverKind::cholmod, Coupling::staged}}) {
    pfv::Options by = options(true);
    by.solver = solver;
    Grains run(data_packing("packing_100.csv"), by);
    const double dt = 2000.0 * run.limit();
    run.flow.advance(run.packing.view(), dt, pfv::Step::trial(Coupling::automatic, run.dynamics()));
    EXPECT_EQ(run.flow.coupling(), wanted);
    if (wanted == Coupling::staged)
      expect_line(refusal([&] { run.advance(Coupling::implicit, dt); }), "use the solver supernodal");
  }
}

// periodic cells

pfv::Box periodic_box() {
  pfv::Box box;
  box.periodic = {true, true, true};
  return box;
}

TEST(ShearPairs, OfAPeriodicCellCloseAroundEachSphere) {
  // the facets of a power cell, each with its normal, add up to nothing; images of a sphere itself cancel
  const pfv::Box box = periodic_box();
  const pfv::Container container = box;
  const pfv::Spheres spheres =
      pfv::select_grains(data_packing("bed_periodic_64.csv").view(), container, pfv::OutsideGrains::refuse).spheres;
  const pfv::PoreSpace space = pfv::build_network(spheres, container.lower);
  const pfv::Throats throats = pfv::measure_throats(
      space.network, pfv::find_pore_boundaries(space.network, container), space.spheres);
  const auto pairs = pfv::shear_pairs(space.network, throats, spheres, space.spheres);
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, spheres.size());
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(spheres.size());
  int beyond = 0;
  for (const pfv::ShearPair& pair : pairs) {
    sums.col(pair.first) += pair.area * pair.direction;
    sums.col(pair.second) -= pair.area * pair.direction;
    areas[pair.first] += pair.area;
    areas[pair.second] += pair.area;
    beyond += !pair.periods.isZero();
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(areas.minCoeff(), 0.0);
  for (int k = 0; k < spheres.size(); ++k) EXPECT_LT(sums.col(k).norm(), 1e-9 * areas[k]) << k;
}

TEST(ShearedSteps, OfAPeriodicCellAreBrakedAndExact) {
  pfv::Box box = periodic_box();
  for (const bool torques : {false, true}) {
    Grains exact(data_packing("bed_periodic_64.csv"), options(true, torques), box);
    expect_forces_of_their_own_velocities(exact, 100.0 * exact.limit(), "periodic");
    for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
      Grains run(data_packing("bed_periodic_64.csv"), options(true, torques), box);
      const double dt = 1000.0 * run.limit();
      const Eigen::Vector3d momentum = run.packing.velocities * run.masses;
      double last = run.energy();
      for (int step = 0; step < 5; ++step) {
        run.move(run.advance(coupling, dt), dt);
        EXPECT_LE(run.energy(), last * (1.0 + 1e-12));
        last = run.energy();
      }
      EXPECT_LT((run.packing.velocities * run.masses - momentum).norm(), 1e-9 * momentum.norm());
    }
  }
}

TEST(ShearForces, OfACellAreThoseOfEightOfThemTogetherAlsoWhereItStretches) {
  const pfv::PackingArrays one = data_packing("bed_periodic_64.csv");
  const Eigen::Index n = one.radii.size();
  std::vector<Sphere> eight;
  const auto shift = [](int image) { return Eigen::Vector3d(image & 1, image >> 1 & 1, image >> 2); };
  for (int image = 0; image < 8; ++image)
    for (int k = 0; k < n; ++k) {
      const Eigen::Vector3d x = 0.5 * (one.positions.col(k) + shift(image));
      eight.push_back({x[0], x[1], x[2], 0.5 * one.radii[k]});
    }
  for (const double stretching : {0.0, 1e-8}) {  // m/s, along x; y shrinks as fast
    const auto box = [&](double by) {
      pfv::Box stretched = periodic_box();
      stretched[Face::xhi].velocity = by;
      stretched[Face::yhi].velocity = -by;
      return stretched;
    };
    Grains alone(one, options(true), box(stretching));
    Grains many(packing_of(eight), options(true), box(2.0 * stretching));
    const Eigen::Vector3d of_periods = stretching * Eigen::Vector3d(1.0, -1.0, 0.0);
    for (int image = 0; image < 8; ++image)
      many.packing.velocities.middleCols(n * image, n) =
          alone.packing.velocities.colwise() + Eigen::Vector3d(of_periods.cwiseProduct(shift(image)));
    const Eigen::Matrix3Xd forces = alone.flow.evaluate(alone.packing.view()).total;
    const Eigen::Matrix3Xd of_many = many.flow.evaluate(many.packing.view()).total;
    for (int image = 0; image < 8; ++image)  // of half the size
      EXPECT_LT((2.0 * of_many.middleCols(n * image, n) - forces).norm(), 1e-8 * forces.norm())
          << image << ' ' << stretching;
  }
}

}  // namespace
}  // namespace sheared_steps_test
