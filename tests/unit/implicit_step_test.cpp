// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit coupling: pressures and velocities of a step found together.
#include "pfv/pfv.hpp"
#include "support/long_steps.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace implicit_step_test {
namespace {

using namespace support;
using pfv::Face;

constexpr double infinite = std::numeric_limits<double>::infinity();
/// How far between the velocities taken and those handed back the ones lie that the pressures belong to.
constexpr double theta = 2.0 / 3.0;

/// The contacts and wall contacts of a packing as linear springs with dashpots, bilateral: the linear
/// system whose stability the study of the scheme was about. Displacements are from the packing's rest.
struct Springs {
  struct Contact {
    int a, b;  ///< b < 0: a wall
    Eigen::Vector3d normal;
    double stiffness;
  };
  std::vector<Contact> contacts;
  double step = infinite;  ///< half of what the stiffest single grain allows, s
  double dashpot = 0.1;    ///< of critical

  Springs(const pfv::PackingArrays& packing, const Eigen::VectorXd& masses) {
    constexpr double modulus = 1e6;
    const auto& x = packing.positions;
    const auto& r = packing.radii;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(r.size());
    const auto add = [&](int a, int b, const Eigen::Vector3d& n, double k) {
      contacts.push_back({a, b, n.normalized(), k});
      sum[a] += k;
      if (b >= 0) sum[b] += k;
    };
    for (int a = 0; a < r.size(); ++a) {
      for (int b = a + 1; b < r.size(); ++b)
        if ((x.col(a) - x.col(b)).norm() < r[a] + r[b])
          add(a, b, x.col(b) - x.col(a), 2.0 * modulus * r[a] * r[b] / (r[a] + r[b]));
      for (int axis = 0; axis < 3; ++axis)
        if (x(axis, a) < r[a] || x(axis, a) > 1.0 - r[a])
          add(a, -1, Eigen::Vector3d::Unit(axis), 2.0 * modulus * r[a]);
    }
    for (int a = 0; a < r.size(); ++a)
      step = std::min(step, 0.5 * std::sqrt(2.0 * masses[a] / sum[a]));
  }
  Eigen::Matrix3Xd forces(const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& v,
                          const Eigen::VectorXd& masses) const {
    Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Zero(3, u.cols());
    for (const Contact& c : contacts) {
      const double mass = c.b < 0 ? masses[c.a] : std::min(masses[c.a], masses[c.b]);
      const double viscous = 2.0 * dashpot * std::sqrt(c.stiffness * mass);
      Eigen::Vector3d du = u.col(c.a), dv = v.col(c.a);
      if (c.b >= 0) {
        du -= u.col(c.b);
        dv -= v.col(c.b);
      }
      const Eigen::Vector3d force =
          -(c.stiffness * du.dot(c.normal) + viscous * dv.dot(c.normal)) * c.normal;
      f.col(c.a) += force;
      if (c.b >= 0) f.col(c.b) -= force;
    }
    return f;
  }
};

/// Grains of a data packing, their displacements so small that the network stays.
struct Sample {
  pfv::PackingArrays packing = data_packing("packing_100.csv");
  Eigen::VectorXd masses = 2600.0 * 4.0 / 3.0 * pi * packing.radii.array().cube();
  Eigen::Matrix3Xd others = Eigen::Matrix3Xd::Zero(3, masses.size());
  Eigen::Matrix3Xd displacements = others;
  std::vector<pfv::Piston> pistons = std::vector<pfv::Piston>(6);
  pfv::Flow flow;

  explicit Sample(double viscosity = 1.0, pfv::Box box = drained(), double bulk_modulus = 0.0)
      : flow(std::move(box), fluid(viscosity, bulk_modulus), with_torques()) {
    Random random(1);
    packing.velocities.resize(3, masses.size());
    packing.angular_velocities = others;
    for (int k = 0; k < masses.size(); ++k) packing.velocities.col(k) = 1e-9 * random.in_cube();
  }
  static pfv::Options with_torques() {
    pfv::Options options;
    options.torques = true;
    return options;
  }
  static pfv::Box drained() {
    return pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, pfv::Wall::symmetry);
  }
  static pfv::Fluid fluid(double viscosity, double bulk_modulus) {
    pfv::Fluid fluid;
    fluid.viscosity = viscosity;
    if (bulk_modulus > 0.0) fluid.bulk_modulus = bulk_modulus;
    return fluid;
  }
  pfv::GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()}, {others.data(), 3, others.cols()}, pistons};
  }
  double limit() {
    flow.evaluate(packing.view(), 1.0);
    return flow.time_step_limit(masses, pistons);
  }
  double speed() const { return packing.velocities.norm(); }
  const pfv::Forces& implicit(double dt) {
    return step_implicit(flow, packing.view(), dt, dynamics());
  }
  struct Velocities {
    Eigen::Matrix3Xd linear, angular;
  };
  /// What the host makes of the forces: those of the step's middle, v(n+3/2), or `part` of the way there.
  Velocities next_velocities(const pfv::Forces& forces, double dt, double part = 1.0) const {
    Velocities next{packing.velocities, packing.angular_velocities};
    next.linear.array() +=
        part * dt * ((forces.total + others).array().rowwise() / masses.transpose().array());
    const Eigen::ArrayXd inertias = 0.4 * masses.array() * packing.radii.array().square();
    next.angular.array() += part * dt * (forces.torque.array().rowwise() / inertias.transpose());
    return next;
  }
  void take(const Velocities& velocities) {
    packing.velocities = velocities.linear;
    packing.angular_velocities = velocities.angular;
  }
  void move(const pfv::Forces& forces, double dt) {
    take(next_velocities(forces, dt));
    displacements += dt * packing.velocities;
  }
  /// Kinetic and elastic energy, without a factor.
  double energy(const Springs& springs) const {
    double sum = 0.0;
    for (int k = 0; k < masses.size(); ++k)
      sum += masses[k] * (packing.velocities.col(k).squaredNorm() +
                          0.4 * std::pow(packing.radii[k], 2) *
                              packing.angular_velocities.col(k).squaredNorm());
    for (const auto& c : springs.contacts) {
      Eigen::Vector3d du = displacements.col(c.a);
      if (c.b >= 0) du -= displacements.col(c.b);
      sum += c.stiffness * std::pow(du.dot(c.normal), 2);
    }
    return sum;
  }
};

// stability

TEST(ImplicitStep, WithContactsEnergyDecaysAtTenThousandLimitsWhereTheExplicitStepExplodes) {
  for (const double ratio : {10.0, 1000.0, 1e4}) {
    Sample probe;
    const Springs springs(probe.packing, probe.masses);
    const double viscosity = ratio * probe.limit() / springs.step;
    Sample run(viscosity), explicit_run(viscosity);
    EXPECT_NEAR(springs.step / run.limit(), ratio, 1e-6 * ratio);
    const double start = run.energy(springs);
    std::vector<double> energies;
    for (int step = 0; step < 1000; ++step) {
      run.others = springs.forces(run.displacements, run.packing.velocities, run.masses);
      run.move(run.implicit(springs.step), springs.step);
      if (step % 200 == 199) energies.push_back(run.energy(springs));
    }
    for (std::size_t i = 0; i < energies.size(); ++i)
      EXPECT_LT(energies[i], i == 0 ? start : energies[i - 1]) << ratio << ' ' << i;
    for (int step = 0; step < 5; ++step) {
      explicit_run.others =
          springs.forces(explicit_run.displacements, explicit_run.packing.velocities, run.masses);
      explicit_run.move(
          explicit_run.flow.step(explicit_run.packing.view(), springs.step), springs.step);
    }
    EXPECT_GT(explicit_run.energy(springs), 1e6 * start) << ratio;
  }
}

// what is solved

TEST(ImplicitStep, PressuresAreThoseOfVelocitiesBetweenThoseTakenAndThoseHandedBack) {
  pfv::Box through = Sample::drained();
  through[Face::zlo].boundary = pfv::Boundary::pressure(1e5);
  through[Face::zhi].boundary = pfv::Boundary::pressure(1e5 + 10.0);
  through[Face::xhi].velocity = 3e-10;
  for (const auto& box : {Sample::drained(), through})
    for (const double bulk_modulus : {0.0, 1e4}) {
      Sample run(1.0, box, bulk_modulus);
      run.others.setConstant(3e-9);
      for (const double limits : {10.0, 100.0, 1000.0}) {
        const double dt = limits * run.limit();
        const pfv::FlowState before = run.flow.state();
        const pfv::Forces forces = run.implicit(dt);
        const auto next = run.next_velocities(forces, dt);
        run.take(run.next_velocities(forces, dt, theta));
        const pfv::Report report = run.flow.report();
        EXPECT_LT(std::abs(report.mass_error), 1e-10);
        EXPECT_LT(report.force_balance_error, 1e-12);
        EXPECT_LT(report.residual, 1e-10);
        pfv::Flow steady(box, Sample::fluid(1.0, bulk_modulus), Sample::with_torques());
        steady.set_state(before);
        steady.evaluate(run.packing.view(), dt);
        const Eigen::VectorXd p = run.flow.pore_pressures();
        EXPECT_LT((steady.pore_pressures() - p).norm(),
                  1e-9 * (p.array() - p.mean()).matrix().norm());
        run.take(next);
      }
    }
}

TEST(ImplicitStep, OfFirstOrderWithAThirdOfTheErrorOfTheExplicitStep) {
  // velocities after 4 limits of time without contacts
  const auto velocities = [](double ratio, bool implicit) {
    Sample run;
    const double dt = ratio * run.limit();
    for (int step = 0; step < static_cast<int>(std::lround(4.0 / ratio)); ++step)
      run.move(implicit ? run.implicit(dt) : run.flow.step(run.packing.view(), dt), dt);
    return run.packing.velocities;
  };
  const Eigen::Matrix3Xd exact = 2.0 * velocities(1.0 / 512, false) - velocities(1.0 / 256, false);
  const auto error = [&](double ratio, bool implicit) {
    return (velocities(ratio, implicit) - exact).norm() / exact.norm();
  };
  const double coarse = error(1.0 / 8, true), half = error(1.0 / 16, true);
  EXPECT_NEAR(coarse / half, 2.0, 0.15);
  EXPECT_NEAR(half / error(1.0 / 16, false), 1.0 / 3.0, 0.02);  // theta - 1/2 against 1/2
}

TEST(ImplicitStep, FrozenGrainsFeelThePlainForce) {
  Sample frozen, plain;
  frozen.masses.setConstant(infinite);
  const Eigen::Matrix3Xd forces = frozen.implicit(1.0).total;
  const Eigen::Matrix3Xd expected = plain.flow.step(plain.packing.view(), 1.0).total;
  EXPECT_LT((forces - expected).norm(), 1e-12 * expected.norm());
}

TEST(ImplicitStep, AFrozenGrainKeepsItsVelocityInTheContinuity) {
  Sample run;
  run.masses.head(40).setConstant(infinite);
  const double dt = 1000.0 * run.limit();
  run.take(run.next_velocities(run.implicit(dt), dt, theta));
  pfv::Flow steady(Sample::drained(), viscosity_one(), Sample::with_torques());
  steady.evaluate(run.packing.view());
  EXPECT_LT((steady.pore_pressures() - run.flow.pore_pressures()).norm(),
            1e-9 * run.flow.pore_pressures().norm());
}

TEST(ImplicitStep, EvaluatingItAdvancesNothing) {
  Sample run;
  const double dt = 50.0 * run.limit();
  const Eigen::Matrix3Xd evaluated =
      try_implicit(run.flow, run.packing.view(), dt, run.dynamics()).total;
  EXPECT_EQ(run.flow.time(), 0.0);
  EXPECT_EQ(run.flow.strain(), 0.0);
  EXPECT_EQ(run.implicit(dt).total, evaluated);
  EXPECT_EQ(run.flow.time(), dt);
}

TEST(ImplicitStep, OneSolveAStepAndOneFactorUntilAMassOrTheStepChanges) {
  Sample run;
  const double dt = 10.0 * run.limit();
  run.implicit(dt);
  const pfv::Counts first = run.flow.report().counts;
  for (int step = 0; step < 5; ++step) run.implicit(dt);
  EXPECT_EQ(run.flow.report().counts.solve, first.solve + 5);
  EXPECT_EQ(run.flow.report().counts.factor, first.factor);
  run.implicit(0.5 * dt);
  run.masses *= 1.1;
  run.implicit(0.5 * dt);
  EXPECT_EQ(run.flow.report().counts.factor, first.factor + 2);
  EXPECT_EQ(run.flow.report().counts.order, first.order);
  run.masses[0] = infinite;
  run.implicit(0.5 * dt);
  EXPECT_EQ(run.flow.report().counts.order, first.order + 1);
}

TEST(ImplicitStep, ANewNetworkGoesOnFromItsOwnPressures) {
  // the same state on the network kept and on one built anew from the same grains
  Sample kept, anew;
  const double dt = 20.0 * kept.limit();
  for (Sample* run : {&kept, &anew}) {
    run->others.row(2).setConstant(-1e-9);
    for (int step = 0; step < 50; ++step) {
      if (run == &anew && step == 40) run->flow.rebuild();
      run->take(run->next_velocities(run->implicit(dt), dt));
    }
  }
  EXPECT_EQ(anew.flow.retriangulations(), 1);
  const double difference =
      (kept.packing.velocities - anew.packing.velocities).norm() / kept.packing.velocities.norm();
  EXPECT_LT(difference, 1e-12);
}

// pistons

/// A sealed piston on top of fixed grains, water leaves at the bottom.
struct PistonOnFixedGrains : Sample {
  static pfv::Box box() {
    pfv::Box box = drained();
    box[Face::zhi].boundary = pfv::Boundary::sealed();
    return box;
  }
  PistonOnFixedGrains() : Sample(1.0, box()) {
    packing.velocities.setZero();
    masses.setConstant(infinite);
  }
  double force_at(double velocity) {
    pfv::Box moving = box();
    moving[Face::zhi].velocity = velocity;
    flow.set_box(moving);
    flow.evaluate(packing.view());
    return force();
  }
  double force() const {
    const pfv::FaceResult& top = flow.faces()[static_cast<int>(Face::zhi)];
    return (top.force_pressure + top.force_viscous)[2];
  }
};

TEST(PistonStep, LimitIsTwiceItsMassOverItsDrag) {
  PistonOnFixedGrains run;
  const double drag = -run.force_at(1.0);
  run.pistons[5].mass = 0.3;
  const double limit = run.flow.time_step_limit(run.masses, run.pistons);
  EXPECT_NEAR(limit / (2.0 * 0.3 / drag), 1.0, 1e-9);  // one degree of freedom: found at once
  run.pistons[5].mass = infinite;
  EXPECT_EQ(run.flow.time_step_limit(run.masses, run.pistons), infinite);
}

TEST(PistonStep, FreeGrainsAndALightPistonLowerTheLimitTogether) {
  PistonOnFixedGrains run;
  Sample free(1.0, PistonOnFixedGrains::box());
  const double grains_alone = free.limit();
  const double fixed_drag = -run.force_at(1.0);
  free.pistons[5].mass = 0.01 * free.masses.sum();
  const double both = free.limit();
  EXPECT_LT(both, grains_alone);
  EXPECT_LT(both, 2.0 * free.pistons[5].mass / fixed_drag);
}

TEST(PistonStep, ImplicitAndStagedReachTheVelocityAtWhichTheDragBearsTheLoad) {
  PistonOnFixedGrains probe;
  const double drag = -probe.force_at(1.0), load = -5.0, mass = 0.1;
  for (const bool implicit : {true, false}) {
    PistonOnFixedGrains run;
    run.pistons[5] = {mass, load};
    const double dt = 200.0 * mass / drag;
    double velocity = 0.0;
    for (int step = 0; step < 10; ++step) {
      pfv::Box box = PistonOnFixedGrains::box();
      box[Face::zhi].velocity = velocity;
      run.flow.set_box(box);
      if (implicit)
        run.implicit(dt);
      else
        step_staged(run.flow, run.packing.view(), dt, run.dynamics());
      const double change = dt / mass * (load + run.force());
      if (implicit) {
        const double weighted = velocity + theta * change;
        EXPECT_NEAR(run.force() / (-drag * weighted), 1.0, 1e-10);
      }
      velocity += change;
      EXPECT_LE(std::abs(velocity), (implicit ? 1.5 : 1.001) * std::abs(load / drag));
    }
    // what is far beyond the limit swings by half from step to step
    EXPECT_NEAR(velocity * drag / load, 1.0, implicit ? 1.1 * std::pow(0.5, 10) : 1e-6);
    EXPECT_LT(std::abs(run.flow.report().mass_error), 1e-10);
  }
}

TEST(PistonStep, AReferencePressureActsOnThePiston) {
  // the same load and 1e5 Pa more behind the water: the piston is lifted by 1e5 Pa times its area
  std::array<double, 2> forces{};
  for (const double base : {0.0, 1e5}) {
    PistonOnFixedGrains run;
    pfv::Box box = PistonOnFixedGrains::box();
    box[Face::zlo].boundary = pfv::Boundary::pressure(base);
    run.flow.set_box(box);
    run.pistons[5] = {1.0, -5.0 - base};
    run.implicit(1.0);
    forces[base > 0.0] = run.force() - base;
  }
  EXPECT_NEAR(forces[1], forces[0], 1e-9 * 1e5);
}

// refusals

TEST(ImplicitStep, RefusesMissingForcesAndImpossibleMasses) {
  Sample run;
  const pfv::GrainDynamics none{{run.masses.data(), run.masses.size()}, {nullptr, 3, 0}, {}};
  expect_line(refusal([&] { step_implicit(run.flow, run.packing.view(), 1.0, none); }),
                       "other force");
  run.masses[2] = 0.0;
  expect_line(refusal([&] { run.implicit(1.0); }), "mass");
  run.masses[2] = 1.0;
  run.pistons[4].mass = -1.0;
  expect_line(refusal([&] { run.implicit(1.0); }), "piston zlo");
}

}  // namespace
}  // namespace implicit_step_test
