// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies of several spheres: their force and torque, their limit, their long steps, what lies within them.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/clumps.hpp"
#include "support/long_steps.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace {

using namespace support;
using pfv::Coupling;
using pfv::Face;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double theta = 2.0 / 3.0;  // of ImplicitStep
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

pfv::Box drained() { return pressure_box(Face::zlo, 0.0, Face::zhi, 0.0, pfv::Wall::symmetry); }

/// The grains cannot go through it together, which nothing would resist.
pfv::Box with_a_floor() { return pressure_box(Face::zhi, 0.0, Face::zhi, 0.0, pfv::Wall::symmetry); }

pfv::Options sheared(bool yes) {
  pfv::Options options;
  options.shear_viscous = yes;
  return options;
}

/// Dumbbells, and single spheres in every fourth place.
Clumps dumbbells(int single = 4) { return Clumps(pair_shape(0.09), 0.09, 3, single); }

struct Case {
  Clumps grains;
  pfv::Flow flow;
  explicit Case(bool shear = false, Clumps of = dumbbells(), const pfv::Box& box = drained(), bool torques = false)
      : grains(std::move(of)), flow(box, viscosity_one(), options(shear, torques)) {}
  static pfv::Options options(bool shear, bool torques) {
    pfv::Options options = sheared(shear);
    options.torques = torques;
    return options;
  }
  double limit() {
    flow.evaluate(grains.packing.view(), 1.0);
    return flow.time_step_limit(grains.masses, {}, grains.bodies);
  }
  const pfv::Forces& advance(Coupling coupling, double dt) {
    const pfv::GrainDynamics dynamics = grains.dynamics();
    return flow.advance(grains.packing.view(), dt, pfv::Step::with(coupling, dynamics));
  }
  /// The drag of one body alone, 6 x 6: what answers a unit of each of its velocities and spins.
  Matrix6 drag_of(std::size_t b) {
    Matrix6 drag;
    for (int c = 0; c < 6; ++c) {
      grains.velocities.setZero();
      grains.spins.setZero();
      (c < 3 ? grains.velocities : grains.spins)(c % 3, static_cast<Eigen::Index>(b)) = 1.0;
      grains.follow();
      drag.col(c) = -grains.on_body(flow.evaluate(grains.packing.view()), b);
    }
    return drag;
  }
};

// forces

TEST(RigidBodies, DragIsSymmetricAndTakesPower) {
  for (const bool shear : {false, true}) {
    Case run(shear);
    const Matrix6 drag = run.drag_of(4);
    EXPECT_LT((drag - drag.transpose()).norm(), 1e-12 * drag.norm()) << shear;
    const Eigen::SelfAdjointEigenSolver<Matrix6> powers(drag);
    EXPECT_GT(powers.eigenvalues()[0], -1e-12 * drag.norm()) << shear;  // of the spin about the axis of the pair
    EXPECT_GT(powers.eigenvalues()[1], 1e-6 * drag.norm()) << shear;
  }
}

TEST(RigidBodies, TwoBodiesAnswerEachOtherAlike) {
  Case run(true);
  const auto answer = [&](Eigen::Index of, Eigen::Index by) {
    Matrix6 block;
    for (int c = 0; c < 6; ++c) {
      run.grains.velocities.setZero();
      run.grains.spins.setZero();
      (c < 3 ? run.grains.velocities : run.grains.spins)(c % 3, by) = 1.0;
      run.grains.follow();
      block.col(c) = run.grains.on_body(run.flow.evaluate(run.grains.packing.view()), of);
    }
    return block;
  };
  const Matrix6 there = answer(2, 3), back = answer(3, 2);
  EXPECT_GT(there.norm(), 0.0);
  EXPECT_LT((there - back.transpose()).norm(), 1e-12 * there.norm());
}

/// What the bodies take about their centres of mass, and their forces there, is what the spheres take about the corner
/// of the box; that balances with the faces (reciprocity_test.cpp).
TEST(RigidBodies, ForcesAndMomentsBalance) {
  Case run(false, dumbbells(0), drained(), true);
  run.grains.stir(1.0);
  const pfv::Forces forces = run.flow.evaluate(run.grains.packing.view());
  EXPECT_LT(run.flow.report().force_balance_error, 1e-12);
  Eigen::Vector3d on_bodies = Eigen::Vector3d::Zero(), on_spheres = on_bodies;
  double scale = 0.0;
  for (std::size_t b = 0; b < run.grains.bodies.size(); ++b) {
    const Vector6 load = run.grains.on_body(forces, b);
    const int first = run.grains.members[b][0];
    const Eigen::Vector3d centre = run.grains.packing.positions.col(first) - run.grains.bodies[b].arms.col(0);
    on_bodies += centre.cross(Eigen::Vector3d(load.head<3>())) + load.tail<3>();
    scale += load.norm();
  }
  for (Eigen::Index k = 0; k < run.grains.masses.size(); ++k)
    on_spheres += Eigen::Vector3d(run.grains.packing.positions.col(k)).cross(Eigen::Vector3d(forces.total.col(k))) +
                  forces.torque.col(k);
  EXPECT_LT((on_bodies - on_spheres).norm(), 1e-12 * scale);
}

// limit

TEST(RigidBodies, LimitOfOneIsTwiceOverItsLargestDrag) {
  for (const bool shear : {false, true}) {
    Case run(shear);
    const Matrix6 drag = run.drag_of(4);
    run.grains.masses.setConstant(infinite);
    for (std::size_t b = 0; b < run.grains.bodies.size(); ++b) {
      if (b == 4) continue;
      run.grains.bodies[b].masses.setConstant(infinite);
      run.grains.bodies[b].inertias.setConstant(infinite);
    }
    const pfv::RigidBody& body = run.grains.bodies[4];
    Matrix6 inverse_root = Matrix6::Zero();
    inverse_root.topLeftCorner<3, 3>() = body.masses.cwiseInverse().cwiseSqrt().asDiagonal();
    inverse_root.bottomRightCorner<3, 3>() =
        body.axes * body.inertias.cwiseInverse().cwiseSqrt().asDiagonal() * body.axes.transpose();
    const double eigenvalue =
        Eigen::SelfAdjointEigenSolver<Matrix6>(inverse_root * drag * inverse_root).eigenvalues()[5];
    const double ratio = run.limit() * eigenvalue / 2.0;
    EXPECT_LT(ratio, 1.0);
    EXPECT_GT(ratio, 0.96);
  }
}

TEST(RigidBodies, ExplicitStepsRestBelowTheLimitAndExplodeAboveIt) {
  for (const bool shear : {false, true}) {
    Case probe(shear);
    const double limit = probe.limit();
    const auto energy_after = [&](double ratio) {
      Case run(shear);
      run.grains.stir(1e-9);
      const double start = run.grains.energy();
      for (int step = 0; step < 300; ++step)
        run.grains.move(run.flow.step(run.grains.packing.view(), ratio * limit), ratio * limit);
      return run.grains.energy() / start;
    };
    EXPECT_LT(energy_after(0.9), 0.5);
    EXPECT_GT(energy_after(1.1), 1e3);
  }
}

// long steps

TEST(RigidBodies, LongStepsLoseEnergyAtAHundredLimits) {
  for (const bool shear : {false, true})
    for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
      Case run(shear, Clumps(tetrahedron_shape(0.1), 0.07, 3, 4), with_a_floor());
      const double dt = 100.0 * run.limit();
      run.grains.stir(1e-9);
      double before = run.grains.energy();
      for (int step = 0; step < 20; ++step) {
        run.grains.move(run.advance(coupling, dt), dt);
        const double now = run.grains.energy();
        EXPECT_LT(now, before) << shear << ' ' << pfv::name_of(coupling) << ' ' << step;
        before = now;
        EXPECT_LT(run.flow.report().force_balance_error, 1e-12);
        EXPECT_LT(std::abs(run.flow.report().mass_error), 1e-9);
      }
    }
}

TEST(RigidBodies, ImplicitPressuresAreThoseOfVelocitiesBetweenThoseTakenAndThoseHandedBack) {
  for (const bool shear : {false, true})
    for (const double limits : {1.0, 100.0}) {
      Case run(shear);
      const double dt = limits * run.limit();
      run.grains.stir(1e-9);
      run.grains.others.setConstant(3e-9);
      run.grains.bodies[1].other_force = {1e-8, 0.0, -2e-8};
      run.grains.bodies[2].other_torque = {0.0, 1e-9, 1e-9};
      run.grains.bodies[3].masses[1] = infinite;
      const pfv::Forces forces = run.advance(Coupling::implicit, dt);
      const Eigen::VectorXd pressures = run.flow.pore_pressures();
      run.grains.move(forces, dt, theta);
      pfv::Flow steady(drained(), viscosity_one(), sheared(shear));
      steady.evaluate(run.grains.packing.view());
      EXPECT_LT((steady.pore_pressures() - pressures).norm(), 1e-9 * pressures.norm()) << shear << ' ' << limits;
    }
}

TEST(RigidBodies, LongStepsTendToShortOnes) {
  for (const bool shear : {false, true})
    for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
      const auto after = [&](Coupling by, double ratio) {
        Case run(shear);
        const double dt = ratio * run.limit();
        run.grains.stir(1e-9);
        run.grains.bodies[1].other_force = {1e-8, 0.0, -2e-8};
        for (int step = 0; step < static_cast<int>(std::lround(4.0 / ratio)); ++step)
          run.grains.move(run.advance(by, dt), dt);
        Eigen::Matrix3Xd motion(3, 2 * run.grains.velocities.cols());
        motion << run.grains.velocities, 0.1 * run.grains.spins;
        return motion;
      };
      const Eigen::Matrix3Xd exact =
          2.0 * after(Coupling::explicit_step, 1.0 / 128) - after(Coupling::explicit_step, 1.0 / 64);
      EXPECT_LT((after(coupling, 2.0) - exact).norm(), 0.25 * exact.norm()) << shear;
      EXPECT_LT((after(coupling, 0.0625) - exact).norm(), 0.012 * exact.norm()) << shear;
    }
}

TEST(RigidBodies, OneThatIsHeldKeepsItsVelocity) {
  Case run;
  for (pfv::RigidBody& body : run.grains.bodies) {
    body.masses.setConstant(infinite);
    body.inertias.setConstant(infinite);
  }
  run.grains.masses.setConstant(infinite);
  run.grains.stir(1e-9);
  const Eigen::Matrix3Xd held = run.advance(Coupling::implicit, 1.0).total;
  Case plain;
  plain.grains.stir(1e-9);
  const Eigen::Matrix3Xd expected = plain.flow.step(plain.grains.packing.view(), 1.0).total;
  EXPECT_LT((held - expected).norm(), 1e-12 * expected.norm());
}

TEST(RigidBodies, OfOneSphereEachAreThatSphere) {
  Eigen::Matrix3Xd one = Eigen::Matrix3Xd::Zero(3, 1);
  for (const Coupling coupling : {Coupling::staged, Coupling::implicit}) {
    Case bodies(true, Clumps(one, 0.12, 3, 0), drained(), true), grains(true, Clumps(one, 0.12, 3, 0), drained(), true);
    bodies.grains.stir(1e-9);
    grains.grains.stir(1e-9);
    const double dt = 20.0 * bodies.limit();
    grains.grains.packing.bodies.resize(0);
    const Eigen::Matrix3Xd held = bodies.advance(coupling, dt).total;
    const pfv::Packing view = grains.grains.packing.view();
    pfv::GrainDynamics dynamics = grains.grains.dynamics();
    dynamics.bodies.clear();
    const Eigen::Matrix3Xd alone = grains.flow.advance(view, dt, pfv::Step::with(coupling, dynamics)).total;
    EXPECT_LT((held - alone).norm(), 1e-10 * alone.norm());
  }
}

// spheres outside the container

TEST(RigidBodies, SpheresLeftOutPassTheirForcesOn) {
  const auto velocity_after = [](bool within) {
    pfv::Options options;
    options.outside = pfv::OutsideGrains::leave_out;
    Clumps grains = dumbbells(0);
    pfv::Box box = drained();
    box.lower[2] = 0.17;  // cuts bodies
    pfv::Flow flow(box, viscosity_one(), options);
    int out = -1;
    for (std::size_t b = 0; b < grains.bodies.size() && out < 0; ++b) {
      const double first = grains.packing.positions(2, grains.members[b][0]), second = grains.packing.positions(2, grains.members[b][1]);
      if ((first < 0.17) != (second < 0.17)) out = grains.members[b][first < 0.17 ? 0 : 1];
    }
    if (out < 0) throw std::logic_error("no body is cut");
    const int b = grains.packing.bodies[out];
    const Eigen::Vector3d force(1.0, 2.0, 3.0);
    if (within) {
      grains.others.col(out) = force;
    } else {
      const Eigen::Vector3d arm = grains.bodies[b].arms.col(grains.members[b][0] == out ? 0 : 1);
      grains.bodies[b].other_force = force;
      grains.bodies[b].other_torque = arm.cross(force);
    }
    const pfv::GrainDynamics dynamics = grains.dynamics();
    return Eigen::Matrix3Xd(flow.advance(grains.packing.view(), 1e-3, pfv::Step::with(Coupling::implicit, dynamics)).total);
  };
  const Eigen::Matrix3Xd on_sphere = velocity_after(true), on_body = velocity_after(false);
  EXPECT_GT(on_body.norm(), 0.0);
  EXPECT_LT((on_sphere - on_body).norm(), 1e-12 * on_body.norm());
}

// volumes

TEST(RigidBodies, TheFluidHasWhatTheirUnionLeaves) {
  Clumps grains = dumbbells(0);
  pfv::Flow whole(drained(), viscosity_one()), flow(drained(), viscosity_one());
  whole.evaluate(grains.packing.view());
  grains.packing.displaced_volumes.resize(grains.masses.size());
  for (const auto& own : grains.members)
    grains.packing.displaced_volumes(own) =
        pfv::union_parts(grains.packing.positions(Eigen::all, own), grains.packing.radii(own));
  flow.evaluate(grains.packing.view());
  const double cap = pi * 0.045 * 0.045 * (3.0 * 0.09 - 0.045) / 3.0;
  EXPECT_NEAR(*flow.report().fluid_volume - *whole.report().fluid_volume, 27 * 2 * cap, 1e-12);
  EXPECT_NEAR(*flow.report().fluid_volume, flow.report().pore_volume, 1e-12);
}

// what lies within

/// Four spheres that close a void between them: the circle through three centres has the radius 1.72 r / sqrt(3) < r, the
/// sphere through four 1.72 r sqrt(3 / 8) > r.
Clumps hollow() { return Clumps(tetrahedron_shape(1.72 * 0.075), 0.075, 3, 0); }

TEST(RigidBodies, AVoidWithinOneIsNoFluid) {
  for (const bool shear : {false, true})
    for (const Coupling coupling : {Coupling::explicit_step, Coupling::staged, Coupling::implicit}) {
      Case run(shear, hollow());
      const double dt = (coupling == Coupling::explicit_step ? 0.5 : 50.0) * run.limit();
      run.grains.stir(1e-9);
      for (int step = 0; step < 3; ++step) run.grains.move(run.advance(coupling, dt), dt);
      EXPECT_EQ(run.flow.report().counts.enclosed_pores, 27);
      EXPECT_EQ(run.flow.report().counts.pinned_pores, 0);
      EXPECT_LT(std::abs(run.flow.report().mass_error), 1e-9);
      EXPECT_LT(run.flow.report().force_balance_error, 1e-12);
    }
}

TEST(RigidBodies, AVoidFilledWithASphereOfTheBodyIsTheSame) {
  Eigen::Matrix3Xd filled(3, 5);
  filled << tetrahedron_shape(1.72 * 0.075), Eigen::Vector3d::Zero();
  Case empty(false, hollow()), full(false, Clumps(filled, 0.075, 3, 0));
  const std::size_t body = 13;
  const Matrix6 of_empty = empty.drag_of(body), of_full = full.drag_of(body);
  EXPECT_LT((of_empty - of_full).norm(), 1e-9 * of_full.norm());
}

TEST(RigidBodies, WithoutThemTheVoidHasNoWayOut) {
  Clumps grains = hollow();
  grains.stir(1e-9);
  for (Eigen::Index k = 0; k < grains.masses.size(); ++k) grains.packing.velocities.col(k) *= 1.0 + 0.1 * (k % 3);
  grains.packing.bodies.resize(0);
  pfv::Flow flow(drained(), viscosity_one());
  expect_line(refusal([&] { flow.evaluate(grains.packing.view()); }), "cut off from every pressure");
}

/// A void between a body of three and a single sphere that is pressed into it.
TEST(RigidBodies, APoreThatANeighbourClosesIsLetOut) {
  Clumps grains = hollow();
  for (auto& own : grains.members) {
    grains.packing.bodies[own[3]] = -1;
    own.pop_back();
  }
  grains.bodies.clear();
  for (const auto& own : grains.members) grains.add_body(own);
  grains.stir(1e-9);
  pfv::Flow flow(drained(), viscosity_one());
  const Eigen::Matrix3Xd forces = flow.evaluate(grains.packing.view()).total;
  EXPECT_TRUE(forces.allFinite());
  EXPECT_EQ(flow.report().counts.joined_pores, 27);
  EXPECT_LT(std::abs(flow.report().mass_error), 1e-9);
  EXPECT_LT(flow.report().force_balance_error, 1e-12);
  EXPECT_LT((forces.array() * grains.packing.velocities.array()).sum(), 0.0);
}

// errors

TEST(RigidBodies, WhatDoesNotFitIsRefused) {
  Case run;
  run.flow.evaluate(run.grains.packing.view());
  const auto limit = [&] { run.flow.time_step_limit(run.grains.masses, {}, run.grains.bodies); };
  const auto bodies = run.grains.bodies;
  run.grains.bodies.pop_back();
  expect_line(refusal(limit), "mass and inertia of 19 bodies are given");
  run.grains.bodies = bodies;
  run.grains.bodies[2].arms.resize(3, 3);
  expect_line(refusal(limit), "rigid body 2: it has 3 arms for 2 spheres");
  run.grains.bodies = bodies;
  run.grains.bodies[2].inertias[1] = 0.0;
  expect_line(refusal(limit), "rigid body 2: a mass or inertia is not a positive number");
  run.grains.bodies = bodies;
  run.grains.bodies[2].axes *= 2.0;
  expect_line(refusal(limit), "axes");
  run.grains.bodies = bodies;
  run.grains.bodies.push_back(bodies[0]);
  expect_line(refusal(limit), "rigid body 20: it holds no sphere");
  run.grains.packing.bodies[0] = -2;
  expect_line(refusal([&] { run.flow.evaluate(run.grains.packing.view()); }), "there is no rigid body -2");
  run.grains.packing.bodies.conservativeResize(1);
  expect_line(refusal([&] { run.flow.evaluate(run.grains.packing.view()); }), "1 numbers of bodies");
}

}  // namespace
