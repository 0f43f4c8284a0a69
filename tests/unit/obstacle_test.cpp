// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes among the grains: the spheres that stand for them, tightness, volumes, forces, motion.
#include "support/meshes.hpp"
#include "support/packings.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "pfv/obstacle.hpp"
#include "pfv/union_parts.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <fstream>

namespace {

using namespace pfv_test;
using Vector = Eigen::Vector3d;

constexpr int grains_a_cube = 50;

/// Two cubes full of grains, one above the other; the plane z = 0 between them touches grains of both.
pfv::PackingArrays two_cubes() {
  pfv::PackingArrays all;
  const pfv::PackingArrays low = pfv::dense_packing(grains_a_cube, 0.58, 0.2, 1), high = pfv::dense_packing(grains_a_cube, 0.58, 0.2, 2);
  const int n = grains_a_cube;
  all.ids.resize(2 * n);
  all.radii.resize(2 * n);
  all.positions.resize(3, 2 * n);
  all.ids << low.ids, high.ids.array() + n;
  all.radii << low.radii, high.radii;
  all.positions << low.positions.colwise() - Vector::UnitZ(), high.positions;
  return all;
}

pfv::Box two_cubes_box() {
  pfv::Box box;
  box.lower = Vector(0, 0, -1);
  box.upper = Vector(1, 1, 1);
  return box;
}

double mean_diameter(const pfv::PackingArrays& packing) { return 2.0 * packing.radii.mean(); }

/// Inflow between pressures at the ends of an axis, with the mesh at rest in the packing.
double flow_past(const Triangles& mesh, int axis, double diameter = 0.5) {
  pfv::PackingArrays packing = two_cubes();
  pfv::Box box = two_cubes_box();
  box.faces[2 * axis].boundary = pfv::Boundary::pressure(1.0);
  box.faces[2 * axis + 1].boundary = pfv::Boundary::pressure(0.0);
  if (!mesh.empty())
    pfv::add_obstacle(packing, pfv::obstacle_of_mesh(mesh, diameter * mean_diameter(packing), "plate "), {}, 1000, box);
  pfv::Fluid fluid;
  fluid.viscosity = 1.0;
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  pfv::Flow flow(box, fluid, options);
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  EXPECT_LT(std::abs(report.mass_error), 1e-12);
  EXPECT_LT(report.force_balance_error, 1e-12);
  return report.inflow;
}

struct Pushed {
  pfv::ObstacleLoad load;
  pfv::Report report;
  double limit;
};

bool touches(const pfv::Obstacle& obstacle, const Vector& place, double radius) {
  for (Eigen::Index j = 0; j < obstacle.size(); ++j)
    if ((place - obstacle.centres.col(j)).norm() < 0.98 * (radius + obstacle.radii[j])) return true;
  return false;
}

/// Grains of a cube that touch neither the obstacle nor another one in its place, and the load on it as it moves.
Pushed push(const pfv::Obstacle& obstacle, const pfv::ObstacleMotion& motion, bool torques = false,
            const pfv::Obstacle& other = {}) {
  const pfv::PackingArrays cube = pfv::dense_packing(300, 0.6, 0.2, 1);
  std::vector<int> kept;
  for (int k = 0; k < cube.radii.size(); ++k)
    if (!touches(obstacle, cube.positions.col(k), cube.radii[k]) && !touches(other, cube.positions.col(k), cube.radii[k]))
      kept.push_back(k);
  pfv::PackingArrays packing;
  packing.ids = pfv::Packing::Ids(cube.ids(kept));
  packing.radii = Eigen::VectorXd(cube.radii(kept));
  packing.positions = Eigen::Matrix3Xd(cube.positions(Eigen::all, kept));
  const auto grains = static_cast<Eigen::Index>(kept.size());
  pfv::Box box;
  box.upper = Vector::Ones();
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::add_obstacle(packing, obstacle, motion, 1000, box);
  pfv::Fluid fluid;
  fluid.viscosity = 1.0;
  pfv::Options options;
  options.shear_viscous = true;
  options.torques = torques;
  pfv::Flow flow(box, fluid, options);
  flow.evaluate(packing.view(), 1e-3);
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(packing.radii.size(), std::numeric_limits<double>::infinity());
  masses.head(grains) = 1e3 * packing.radii.head(grains).array().cube();
  const double limit = flow.time_step_limit(masses, {}, {pfv::held_body(obstacle, motion.placement)});
  return {pfv::load_on(packing.view(), flow.forces(), grains, obstacle.size(), obstacle.centre), flow.report(), limit};
}

TEST(Obstacles, ClosedMeshesHaveTheirVolumeAndNoSphereStandsOut) {
  const std::vector<std::pair<Triangles, double>> bodies{
      {sphere_mesh(Vector::Zero(), 0.5, 2), 0.0}, {block_mesh(Vector::Constant(-0.5), Vector::Constant(0.5)), 1.0},
      {cylinder_mesh(Vector::Zero(), 0.3, 1.0, 32), 16 * std::sin(2 * M_PI / 32) * 0.09}};
  for (const auto& [mesh, volume] : bodies)
    for (const double diameter : {0.2, 0.125}) {
      const pfv::Obstacle found = pfv::obstacle_of_mesh(mesh, diameter, "body ");
      EXPECT_EQ(found.solids, 1);
      EXPECT_EQ(found.sheets, 0);
      if (volume > 0.0) {
        EXPECT_NEAR(found.volume, volume, 1e-12);
      }
      EXPECT_NEAR(found.union_volume / found.volume, 1.0, 1e-3);
      EXPECT_LT(found.protrusion, 0.1 * diameter);
      EXPECT_LT(found.recess, 0.6 * diameter);  // at the corners of the block
      EXPECT_NEAR(found.displaced.sum(), found.volume, 1e-12);
      EXPECT_LT((found.centres * found.displaced).norm(), 1e-12);  // lift acts at the middle
    }
}

TEST(Obstacles, AMeshOfASphereIsOneSphereWhereItIsAsRound) {
  const Triangles mesh = sphere_mesh(Vector(0.5, 0.5, 0.5), 0.2, 3);
  const pfv::Obstacle found = pfv::obstacle_of_mesh(mesh, 0.2, "ball ");
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found.radii[0], 0.2, 0.003);
}

pfv::Obstacle one_sphere(const pfv::Obstacle& obstacle) {
  pfv::Obstacle one;
  one.centre = obstacle.centre;
  one.centres = one.centre;
  one.volume = obstacle.volume;
  one.radii = Eigen::VectorXd::Constant(1, std::cbrt(one.volume * 3 / (4 * M_PI)));
  one.displaced = Eigen::VectorXd::Constant(1, one.volume);
  return one;
}

/// About the middle of the cube.
Triangles turned(Triangles mesh, const Eigen::Quaterniond& turn) {
  const Vector middle(0.5, 0.5, 0.5);
  for (pfv::Triangle& triangle : mesh)
    triangle = ((turn.normalized().toRotationMatrix() * (triangle.colwise() - middle)).colwise() + middle).eval();
  return mesh;
}

/// A sphere of few triangles becomes many spheres: the drag on them against that on the one of the same volume among the
/// same grains, however the spheres lie. Fluid between a grain that nearly touches and the creases is none.
TEST(Obstacles, DragOfManySpheresIsThatOfTheOne) {
  support::Random random(3);
  const auto component = [&] { return random(-1.0, 1.0); };
  double least = 1.0, most = 0.0, sum = 0.0;
  int count = 0;
  for (int sample = 0; sample < 4; ++sample) {
    const Eigen::Quaterniond turn = sample == 0 ? Eigen::Quaterniond::Identity()
                                                : Eigen::Quaterniond(component(), component(), component(), component());
    const Triangles mesh = turned(sphere_mesh(Vector(0.5, 0.5, 0.5), 0.2, 2), turn);
    const pfv::Obstacle many = pfv::obstacle_of_mesh(mesh, 0.08, "ball "), one = one_sphere(many);
    ASSERT_GT(many.size(), 30);
    for (int axis = 0; axis < 3; ++axis) {
      pfv::ObstacleMotion motion;
      motion.velocity = Vector::Unit(axis);
      const Pushed of_many = push(many, motion, false, one), of_one = push(one, motion, false, many);
      const double ratio = of_many.load.force[axis] / of_one.load.force[axis];
      least = std::min(least, ratio);
      most = std::max(most, ratio);
      sum += ratio;
      ++count;
      EXPECT_LT(of_many.report.force_balance_error, 1e-13);
      EXPECT_GT(of_many.limit / of_one.limit, 0.98);  // pockets between the spheres do not brake
    }
  }
  std::printf("drag on many spheres over that on one: %.3f to %.3f, mean %.3f of %d\n", least, most, sum / count, count);
  EXPECT_GT(least, 0.85);
  EXPECT_LT(most, 0.94);
}

/// A symmetric mesh is full of ties; the last digits of its places do not decide.
TEST(Obstacles, SpheresDoNotDependOnOriginOrUnit) {
  const auto expect_alike = [](const Triangles& mesh, double diameter) {
    const pfv::Obstacle expected = pfv::obstacle_of_mesh(mesh, diameter, "body ");
    for (const auto& [unit, away] : {std::pair(1.0, 0.1), std::pair(1e-3, 3.7)}) {
      Triangles other = mesh;
      for (pfv::Triangle& triangle : other) triangle = (unit * (triangle.array() + away)).matrix().eval();
      const pfv::Obstacle found = pfv::obstacle_of_mesh(other, unit * diameter, "body ");
      ASSERT_EQ(found.size(), expected.size()) << unit << " " << away;
      const Eigen::Matrix3Xd strayed = found.centres / unit - (expected.centres.array() + away).matrix();
      EXPECT_LT(strayed.cwiseAbs().maxCoeff(), 1e-6 * diameter) << unit << " " << away;
      EXPECT_LT((found.radii / unit - expected.radii).cwiseAbs().maxCoeff(), 1e-6 * diameter) << unit << " " << away;
    }
  };
  expect_alike(sphere_mesh(Vector(0.5, 0.5, 0.5), 0.2, 2), 0.08);
  expect_alike(plate_mesh(0, 1, 0, 1, 0.3), 0.4);
  expect_alike(block_mesh(Vector::Constant(-0.5), Vector::Constant(0.5)), 0.4);
  expect_alike(block_mesh({-0.1, -0.1, -0.03}, {1.1, 1.1, 0.03}), 0.5);
  expect_alike(cylinder_mesh(Vector::Zero(), 0.3, 1.0, 32), 0.3);
}

/// Limit of the explicit coupling of the grains of a cube around an obstacle that was put over them.
double limit_among_grains(const pfv::Obstacle& obstacle, pfv::PackingArrays packing) {
  pfv::Box box;
  box.upper = Vector::Ones();
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  const Eigen::Index grains = packing.radii.size();
  pfv::add_obstacle(packing, obstacle, {}, 1000, box);
  pfv::Fluid fluid;
  fluid.viscosity = 1.0;
  pfv::Options options;
  options.outside = pfv::OutsideGrains::leave_out;
  pfv::Flow flow(box, fluid, options);
  flow.evaluate(packing.view());
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(packing.radii.size(), std::numeric_limits<double>::infinity());
  masses.head(grains) = 1e3 * packing.radii.head(grains).array().cube();
  return flow.time_step_limit(masses, {}, {pfv::held_body(obstacle, {})});
}

/// Pores that grains within its body and deep overlaps all but close would ask for steps of 2e-9 to 1.4e-5 s.
TEST(Obstacles, GrainsThatStickInOneAreFoundAndDoNotShutFluidIn) {
  for (int sample = 0; sample < 6; ++sample) {
    const Vector shift = 0.013 * Vector(sample, 2 * sample % 7, 3 * sample % 11);
    const Triangles plate = block_mesh(Vector(0.2, -0.1, 0.4) + shift, Vector(0.6, 1.1, 0.52) + shift);
    const pfv::Obstacle obstacle = pfv::obstacle_of_mesh(plate, 0.06, "plate ");
    const pfv::PackingArrays packing = pfv::dense_packing(300, 0.6, 0.2, 1 + sample);
    const std::vector<std::int64_t> stuck = pfv::spheres_stuck_in(packing.view(), obstacle, {});
    std::vector<std::int64_t> expected;
    for (Eigen::Index k = 0; k < packing.radii.size(); ++k) {
      const auto away = (obstacle.centres.colwise() - packing.positions.col(k)).colwise().norm().transpose();
      if ((away.array() < obstacle.radii.array()).any()) expected.push_back(packing.ids[k]);
    }
    EXPECT_GT(expected.size(), 5u);
    EXPECT_EQ(stuck, expected);
    EXPECT_EQ(pfv::warning_of_stuck(stuck).find(std::to_string(stuck.size()) + " grains stick in it"), 0u);
    EXPECT_GT(limit_among_grains(obstacle, packing), 1e-4) << sample;
  }
  EXPECT_EQ(pfv::warning_of_stuck({}), "");
}

TEST(Obstacles, NothingFlowsThroughASheetOrAThinWall) {
  const double without = flow_past({}, 2);
  EXPECT_LT(flow_past(plate_mesh(0, 1, 0, 1, 0), 2) / without, 1e-15);             // ends at the walls
  EXPECT_LT(flow_past(plate_mesh(-0.1, 1.1, -0.1, 1.1, 0), 2) / without, 1e-15);  // reaches through them
  EXPECT_LT(flow_past(block_mesh({-0.1, -0.1, -0.03}, {1.1, 1.1, 0.03}), 2, 0.8) / without, 1e-15);
  EXPECT_LT(flow_past(block_mesh({-0.1, -0.1, -0.15}, {1.1, 1.1, 0.15}), 2) / without, 1e-15);
}

TEST(Obstacles, AHoleInASheetLetsThrough) {
  Triangles mesh;
  for (const auto& [x0, x1, y0, y1] : {std::array{0.0, 1.0, 0.0, 0.3}, {0.0, 1.0, 0.7, 1.0}, {0.0, 0.3, 0.3, 0.7}, {0.7, 1.0, 0.3, 0.7}})
    for (const pfv::Triangle& triangle : plate_mesh(x0, x1, y0, y1, 0.0)) mesh.push_back(triangle);
  const double part = flow_past(mesh, 2) / flow_past({}, 2);
  EXPECT_GT(part, 0.3);
  EXPECT_LT(part, 0.8);
}

/// Beside a no-slip wall of the box in its place: its thickness and roughness cost so much.
TEST(Obstacles, FlowAlongASheetIsThatAlongAWall) {
  double halves = 0.0;
  const pfv::PackingArrays all = two_cubes();
  for (int half = 0; half < 2; ++half) {
    pfv::PackingArrays packing;
    packing.ids = pfv::Packing::Ids(all.ids.segment(half * grains_a_cube, grains_a_cube));
    packing.radii = Eigen::VectorXd(all.radii.segment(half * grains_a_cube, grains_a_cube));
    packing.positions = Eigen::Matrix3Xd(all.positions.middleCols(half * grains_a_cube, grains_a_cube));
    pfv::Box box = two_cubes_box();
    (half ? box.lower : box.upper)[2] = 0.0;
    box[pfv::Face::xlo].boundary = pfv::Boundary::pressure(1.0);
    box[pfv::Face::xhi].boundary = pfv::Boundary::pressure(0.0);
    pfv::Fluid fluid;
    fluid.viscosity = 1.0;
    pfv::Flow flow(box, fluid);
    flow.evaluate(packing.view());
    halves += flow.report().inflow;
  }
  const double coarse = flow_past(plate_mesh(0, 1, 0, 1, 0), 0, 1.0) / halves;
  const double usual = flow_past(plate_mesh(0, 1, 0, 1, 0), 0, 0.5) / halves;
  std::printf("flow along a sheet over that along a wall: %.3f (thickness 0.6 d), %.3f (0.3 d)\n", coarse, usual);
  EXPECT_GT(usual, 0.85);
  EXPECT_GT(usual, coarse);
  EXPECT_LT(usual, 1.0);
}

TEST(Obstacles, RigidMotionMovesNoFluidInTheSum) {
  const pfv::Obstacle block = pfv::obstacle_of_mesh(block_mesh({0.35, 0.3, 0.4}, {0.65, 0.7, 0.6}), 0.1, "block ");
  pfv::ObstacleMotion motion;
  motion.pivot = block.centre;
  motion.velocity = Vector(0.3, -0.2, 0.5);
  Pushed pushed = push(block, motion);
  EXPECT_LT(std::abs(pushed.report.volume_rate_sum), 1e-15);
  EXPECT_LT(pushed.report.force_balance_error, 1e-13);
  EXPECT_LT(pushed.load.force.dot(motion.velocity), 0.0);
  motion.velocity.setZero();
  motion.spin = Vector(0.2, 1.0, -0.4);
  pushed = push(block, motion, true);
  EXPECT_LT(std::abs(pushed.report.volume_rate_sum), 1e-14);
  EXPECT_LT(std::abs(pushed.report.mass_error), 1e-10);
  EXPECT_LT(pushed.load.moment.dot(motion.spin), 0.0);
}

TEST(Obstacles, PlacementIsTheRigidMotion) {
  const Triangles before = block_mesh({0, 0, 0}, {1, 2, 3});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector(1, -2, 0.5).normalized()).toRotationMatrix();
  Triangles after = before;
  for (pfv::Triangle& triangle : after) triangle = (turn * triangle).colwise() + Vector(3, -1, 2);
  const pfv::Placement found = pfv::placement_between(before, after, "mesh ");
  EXPECT_LT((found.turn - turn).norm(), 1e-12);
  EXPECT_LT((found.shift - Vector(3, -1, 2)).norm(), 1e-12);
  const Triangles plate = plate_mesh(0, 1, 0, 1, 0);  // a plane does not say which of two it was: no reflection
  EXPECT_GT(pfv::placement_between(plate, plate, "mesh ").turn.determinant(), 0.0);
  after[0] *= 1.01;
  EXPECT_THROW(pfv::placement_between(before, after, "mesh "), pfv::InputError);
}

TEST(Obstacles, WhatCannotBeIsRefused) {
  EXPECT_THROW(pfv::obstacle_of_mesh({}, 0.1, "mesh "), pfv::InputError);
  EXPECT_THROW(pfv::obstacle_of_mesh(plate_mesh(0, 1, 0, 1, 0), 0.0, "mesh "), pfv::InputError);
  EXPECT_THROW(pfv::obstacle_of_mesh(plate_mesh(0, 1, 0, 1, 0), 1e-4, "mesh "), pfv::InputError);
  EXPECT_THROW(pfv::obstacle_of_mesh(plate_mesh(0, 0, 0, 1, 0), 0.1, "mesh "), pfv::InputError);
  Triangles broken = plate_mesh(0, 1, 0, 1, 0);
  broken[1](0, 0) = std::nan("");
  EXPECT_THROW(pfv::obstacle_of_mesh(broken, 0.1, "mesh "), pfv::InputError);
}

TEST(Obstacles, StlFilesOfBothKindsAreRead) {
  const Triangles mesh = block_mesh({0, 0, 0}, {1, 2, 3});
  const std::string text = testing::TempDir() + "block_text.stl", binary = testing::TempDir() + "block_binary.stl";
  std::ofstream as_text(text), as_binary(binary, std::ios::binary);
  as_text << "solid block\n";
  const std::uint32_t count = static_cast<std::uint32_t>(mesh.size());
  as_binary << "solid, says even this header" << std::string(52, ' ');
  as_binary.write(reinterpret_cast<const char*>(&count), 4);
  for (const pfv::Triangle& triangle : mesh) {
    as_text << "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) as_text << "vertex " << triangle.col(k).transpose() << "\n";
    as_text << "endloop\nendfacet\n";
    Eigen::Matrix<float, 3, 4> record;
    record << Eigen::Vector3f::Zero(), triangle.cast<float>();
    as_binary.write(reinterpret_cast<const char*>(record.data()), 48);
    as_binary.write("\0\0", 2);
  }
  as_text.close();
  as_binary.close();
  for (const std::string& path : {text, binary}) EXPECT_EQ(pfv::read_stl(path), mesh) << path;
  std::ofstream(text) << "facet\nvertex 0 0 0\nvertex 1 0\n";
  EXPECT_THROW(pfv::read_stl(text), pfv::InputError);
  std::ofstream(text) << "nothing\n";
  EXPECT_THROW(pfv::read_stl(text), pfv::InputError);
}

}  // namespace
