// SPDX-License-Identifier: GPL-3.0-or-later
// Volume rates are S^T v: one operator for forces and volumes, as Lorentz' reciprocal theorem demands.
#include "pfv/pfv.hpp"
#include "support/long_steps.hpp"
#include "support/boxes.hpp"
#include "support/motions.hpp"
#include "support/packings.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace reciprocity_test {
namespace {

using namespace support;

/// Dense, loose, unlike, overlapping and cospherical grains between walls of either kind.
std::vector<Stages> samples() {
  std::vector<Stages> result;
  for (const auto wall : {pfv::Wall::no_slip, pfv::Wall::symmetry})
    for (const auto& packing :
         {data_packing("packing_500.csv"), random_packing(200, 0.02, 0.08, 3),
          lattice(Lattice::fcc, 3), nine_spheres(0.1)})
      result.push_back(stages_of(packing, upward_box(wall)));
  return result;
}

/// All spheres and faces as parts of one rigid body that turns about a point; in coordinates from the
/// corner of the box.
pfv::Motion rotation(const Stages& s, const Eigen::Vector3d& spin, const Eigen::Vector3d& about) {
  pfv::Motion motion(6, s.spheres.size() + 6);
  for (int k = 0; k < s.spheres.size(); ++k)
    motion.col(k).head<3>() = spin.cross(s.spheres.centres.col(k) - about);
  for (int face = 0; face < 6; ++face)
    motion.col(s.spheres.size() + face).head<3>() = spin.cross(-about);
  motion.bottomRows<3>().colwise() = spin;
  return motion;
}

pfv::Options with_torques() {
  pfv::Options options;
  options.torques = true;
  return options;
}

double mean_volume(const Stages& s) { return 1.0 / s.network.pores(); }

TEST(Reciprocity, WhatMovesAsOneRigidBodyMovesNoFluid) {
  for (const Stages& s : samples()) {
    pfv::Motion shift = pfv::Motion::Zero(6, s.spheres.size() + 6);
    shift.topRows<3>().colwise() = Eigen::Vector3d(0.3, -1.0, 2.0);
    EXPECT_LT(reciprocal_rates(s, shift).cwiseAbs().maxCoeff(), 1e-12 * mean_volume(s));
    const pfv::Motion turn = rotation(s, {0.3, -0.7, 1.1}, {0.2, 0.9, -0.4});
    EXPECT_LT(reciprocal_rates(s, turn).cwiseAbs().maxCoeff(), 1e-12 * mean_volume(s));
  }
}

// Without moments it would: 0.13 of the mean pore's volume a radian in this packing.
TEST(Reciprocity, ARotationNeedsTheSpinsOfTheGrains) {
  const Stages s = stages_of(data_packing("packing_500.csv"), upward_box(pfv::Wall::symmetry));
  pfv::Motion turn = rotation(s, {0.0, 0.0, 1.0}, {0.5, 0.5, 0.5});
  turn.bottomLeftCorner(3, s.spheres.size()).setZero();
  EXPECT_GT(reciprocal_rates(s, turn).norm(), 1e-3 * std::sqrt(s.network.pores()) * mean_volume(s));
}

// As the geometric rates do: the centres of a facet lie in its plane and have one velocity normal to it,
// whatever the shares are. A no-slip wall does not stretch with the grains and holds fluid back beside it.
TEST(Reciprocity, UniformExpansionGivesThreeTimesEachVolume) {
  for (const Stages& s : samples()) {
    pfv::Box box = *pfv::box_of(s.box);
    for (const pfv::Face face : pfv::all_faces)
      if (pfv::is_upper(face)) box[face].velocity = 1.0;
    const Eigen::VectorXd rates = reciprocal_rates(s, motion_of(s.spheres.centres, box));
    EXPECT_NEAR(rates.sum(), 3.0, 1e-12);
    const Eigen::VectorXd volumes = geometric_rates(s, s.spheres.centres, box);
    std::vector<char> beside_wall(s.network.pores(), 0);
    if (box[pfv::Face::xlo].wall == pfv::Wall::no_slip)
      for (int c = 0; c < s.network.cells(); ++c)
        if (pfv::is_wall(s.network.cell_vertices[c][3])) beside_wall[s.network.cell_pore[c]] = 1;
    for (int pore = 0; pore < s.network.pores(); ++pore)
      if (!beside_wall[pore]) {
        EXPECT_NEAR(rates[pore], volumes[pore], 1e-12 * mean_volume(s));
      }
  }
}

TEST(Reciprocity, RatesAddUpToThatOfTheBoxForAnyMotion) {
  for (const Stages& s : samples()) {
    Random random(4);
    pfv::Box box;
    box[pfv::Face::xlo].velocity = -0.25;
    box[pfv::Face::yhi].velocity = -0.5;
    box[pfv::Face::zhi].velocity = 0.125;
    box[pfv::Face::zhi].sliding = {1.0, 2.0, 0.0};
    box[pfv::Face::zhi].spin = 3.0;
    Eigen::Matrix3Xd velocities(3, s.spheres.size());
    for (int k = 0; k < s.spheres.size(); ++k) velocities.col(k) = random.in_cube();
    pfv::Motion motion = motion_of(velocities, box);
    for (int k = 0; k < s.spheres.size(); ++k) motion.col(k).tail<3>() = random.in_cube();
    EXPECT_NEAR(reciprocal_rates(s, motion).sum(), 0.25 - 0.5 + 0.125, 1e-12);
  }
}

TEST(Reciprocity, MomentsOfSpheresAndFacesCancelForAnyPressures) {
  for (const Stages& s : samples()) {
    Random random(8);
    Eigen::VectorXd p(s.network.pores());
    for (int i = 0; i < p.size(); ++i) p[i] = random(-1.0, 1.0);
    const pfv::Loads loads = pfv::multiply(force_matrix_of(s), p);
    Eigen::Vector3d sum = loads.bottomRows<3>().rowwise().sum();
    for (int k = 0; k < s.spheres.size(); ++k)
      sum += s.spheres.centres.col(k).cross(loads.col(k).head<3>());
    const pfv::Bases bases = bases_of(s);
    for (int b = 0; b < bases.size(); ++b) sum += p[bases.pore[b]] * bases.load(b).tail<3>();
    EXPECT_LT(sum.norm(), 1e-12);
  }
}

// A pressure that is the same on all sides of a sphere pushes through its centre, whatever its contacts are.
TEST(Reciprocity, DiscsTurnNoSphereInAnEvenPressure) {
  const Stages s = stages_of(data_packing("packing_500.csv"), upward_box(pfv::Wall::no_slip));
  const pfv::Loads loads = pfv::multiply(
      force_matrix_of(s, pfv::ConductanceLaw::open_throat, {true, false, true}),
      Eigen::VectorXd::Ones(s.network.pores()));
  EXPECT_LT(loads.cwiseAbs().maxCoeff(), 1e-15);
}

// Lorentz: the flux through a face when a sphere alone moves or turns is its force or torque at rest when that
// face alone has a pressure.
TEST(Reciprocity, FluxOfASphereThatMovesAloneIsItsForceUnderAPressureThere) {
  auto packing = data_packing("packing_100.csv");
  pfv::Flow still(upward_box(pfv::Wall::no_slip), viscosity_one(), with_torques());
  const pfv::Forces forces = still.evaluate(packing.view());
  pfv::Flow moving(pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::no_slip),
                   viscosity_one(), with_torques());
  const auto flux = [&] { return moving.faces()[static_cast<int>(pfv::Face::zlo)].flux; };
  for (const int k : {3, 40, 77})
    for (int axis = 0; axis < 3; ++axis) {
      packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
      packing.angular_velocities = packing.velocities;
      packing.velocities(axis, k) = 1.0;
      moving.evaluate(packing.view());
      EXPECT_NEAR(flux(), forces.total(axis, k),
                  1e-10 * forces.total.col(k).norm());
      packing.velocities(axis, k) = 0.0;
      packing.angular_velocities(axis, k) = 1.0;
      moving.evaluate(packing.view());
      EXPECT_NEAR(flux(), forces.torque(axis, k),
                  1e-10 * forces.total.col(k).norm());
    }
}

/// S G^-1 S^T: minus the forces and torques that velocities and spins of each sphere cause, column by column.
Eigen::MatrixXd resistance(pfv::PackingArrays packing, const pfv::Box& box) {
  const auto n = static_cast<int>(packing.radii.size());
  pfv::Flow flow(box, viscosity_one(), with_torques());
  packing.velocities = packing.angular_velocities = Eigen::Matrix3Xd::Zero(3, n);
  Eigen::MatrixXd matrix(6 * n, 6 * n);
  for (int c = 0; c < 6 * n; ++c) {
    Eigen::Matrix3Xd& part = c % 6 < 3 ? packing.velocities : packing.angular_velocities;
    part(c % 3, c / 6) = 1.0;
    const pfv::Forces& forces = flow.evaluate(packing.view());
    part(c % 3, c / 6) = 0.0;
    for (int k = 0; k < n; ++k) {
      matrix.block<3, 1>(6 * k, c) = -forces.total.col(k);
      matrix.block<3, 1>(6 * k + 3, c) = -forces.torque.col(k);
    }
  }
  return matrix;
}

TEST(Reciprocity, TheResistanceIsSymmetricAndNoMotionIsFed) {
  const pfv::Box box =
      pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::no_slip);
  for (const auto& packing : {data_packing("packing_100.csv"), random_packing(60, 0.02, 0.1, 5)}) {
    const Eigen::MatrixXd r = resistance(packing, box);
    EXPECT_LT((r - r.transpose()).norm(), 1e-12 * r.norm());
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (r + r.transpose())).eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), -1e-13 * eigenvalues.maxCoeff());
  }
}

TEST(Reciprocity, ASlidingNoSlipWallTakesFluidAlongAndASymmetryWallNone) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  for (const bool no_slip : {true, false}) {
    pfv::Box box = pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0,
                                no_slip ? pfv::Wall::no_slip : pfv::Wall::symmetry);
    box[pfv::Face::yhi].sliding = {1.0, 0.0, 0.0};
    pfv::Flow flow(box, viscosity_one());
    const Eigen::Matrix3Xd& forces = flow.evaluate(packing.view()).total;
    const auto faces = flow.face_forces();
    if (no_slip) {
      EXPECT_GT(forces.norm(), 0.0);
      EXPECT_LT(faces[3][0], 0.0) << "the fluid holds the wall back";
    } else {
      EXPECT_EQ(forces.norm(), 0.0);
    }
    EXPECT_LT(flow.report().force_balance_error, 1e-13);
    EXPECT_LT(std::abs(flow.report().mass_error), 1e-13);
  }
}

// Three spheres around the axis of a turning lid: the torque on it holds it back, and without spin and
// sliding a spin about any pivot is the same as the velocity of the pivot's frame.
TEST(Reciprocity, ATurningLidIsASlidingOneAboutAFarPivot) {
  auto packing = data_packing("packing_100.csv");
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  pfv::Box slides = pressure_box(pfv::Face::zlo, 0.0, pfv::Face::ylo, 0.0, pfv::Wall::no_slip);
  pfv::Box turns = slides;
  slides[pfv::Face::zhi].sliding = {1.0, 0.0, 0.0};
  turns[pfv::Face::zhi].spin = 1e-8;
  turns[pfv::Face::zhi].pivot = {0.0, 1e8, 0.0};
  pfv::Flow a(slides, viscosity_one()), b(turns, viscosity_one());
  const Eigen::Matrix3Xd forces = a.evaluate(packing.view()).total;
  EXPECT_GT(forces.norm(), 0.0);
  EXPECT_LT((forces - b.evaluate(packing.view()).total).norm(), 1e-6 * forces.norm());
}

TEST(Reciprocity, ThreadsChangeNoByteOfRates) {
  auto packing = data_packing("packing_500.csv");
  Random random(2);
  packing.velocities.resize(3, packing.radii.size());
  for (int k = 0; k < packing.radii.size(); ++k) packing.velocities.col(k) = random.in_cube();
  packing.angular_velocities = packing.velocities;
  pfv::Options shared = with_torques();
  shared.threads = 3;
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  pfv::Flow one(box, viscosity_one(), with_torques()), three(box, viscosity_one(), shared);
  EXPECT_TRUE(one.evaluate(packing.view()).total == three.evaluate(packing.view()).total);
  EXPECT_TRUE(one.forces().torque == three.forces().torque);
  EXPECT_EQ(one.report().volume_rate_sum, three.report().volume_rate_sum);
}

// Without torques the spins are not asked for, and the resistance of the velocities alone is as it should be.
TEST(Reciprocity, WithoutTorquesSpinsMoveNothingAndNoVelocityIsFed) {
  auto packing = data_packing("packing_100.csv");
  const auto n = static_cast<int>(packing.radii.size());
  const pfv::Box box =
      pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::no_slip);
  packing.velocities = packing.angular_velocities = Eigen::Matrix3Xd::Zero(3, n);
  packing.angular_velocities.setOnes();
  pfv::Flow flow(box, viscosity_one());
  EXPECT_EQ(flow.evaluate(packing.view()).total.norm(), 0.0);
  EXPECT_EQ(flow.forces().torque.cols(), 0);
  EXPECT_EQ(flow.report().counts.volume_rate, 0);
  Eigen::MatrixXd r(3 * n, 3 * n);
  for (int c = 0; c < 3 * n; ++c) {
    packing.velocities(c % 3, c / 3) = 1.0;
    r.col(c) = -flow.evaluate(packing.view()).total.reshaped();
    packing.velocities(c % 3, c / 3) = 0.0;
  }
  EXPECT_LT((r - r.transpose()).norm(), 1e-12 * r.norm());
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (r + r.transpose())).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-13 * eigenvalues.maxCoeff());
}

TEST(GeometricRates, ActAtTheCentresAndRefuseLongSteps) {
  auto packing = data_packing("packing_100.csv");
  pfv::Options papers;
  papers.volume_rates = pfv::VolumeRates::geometric;
  pfv::Flow flow(upward_box(pfv::Wall::no_slip), viscosity_one(), papers);
  EXPECT_EQ(flow.evaluate(packing.view()).torque.cols(), 0);
  EXPECT_EQ(flow.report().counts.volume_rate, 0);
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(packing.radii.size());
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  const pfv::GrainDynamics grains{{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  expect_line(refusal([&] { step_staged(flow, packing.view(), 1.0, grains); }), "reciprocal");
  expect_line(refusal([&] { step_implicit(flow, packing.view(), 1.0, grains); }), "reciprocal");
}

}  // namespace
}  // namespace reciprocity_test
