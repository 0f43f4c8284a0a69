// SPDX-License-Identifier: GPL-3.0-or-later
// Planes at any angle and cylinders: what a container holds is what its pores hold, and a box is one of them.
#include "pfv/container.hpp"
#include "pfv/flow.hpp"
#include "physics/cell_volumes.hpp"
#include "problem/container_geometry.hpp"
#include "support/boxes.hpp"
#include "support/containers.hpp"
#include "support/motions.hpp"

#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>
#include <utility>

namespace container_test {
namespace {

using namespace support;

struct Case {
  std::string name;
  pfv::Container container;
};

std::vector<Case> polyhedra() {
  return {{"prism of 5", frustum(5, 0.0)},   {"prism of 8", frustum(8, 0.0)},  {"prism of 16", frustum(16, 0.0)},
          {"hopper", frustum(6, 0.35)},      {"tent", frustum(4, -0.3)},       {"pyramid", pyramid()},
          {"wedge", wedge()},                {"turned cube", turned_cube(some_turn())}};
}
std::vector<Case> cylinders() {
  return {{"upright", cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 1.0)},
          {"along x", cylinder({1, 0, 0}, {-3, 2, 1}, 0.5, 1.5)},
          {"oblique", cylinder({1, -2, 0.7}, {10, 20, 30}, 0.7, 1.1)}};
}
std::vector<Case> all_containers() {
  std::vector<Case> all = polyhedra();
  for (Case& one : cylinders()) all.push_back(std::move(one));
  return all;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

/// Pressure 1 on one face, 0 on another, the rest walls of one type.
pfv::Container driven(pfv::Container container, const std::string& from, const std::string& to,
                      pfv::Wall wall = pfv::Wall::no_slip) {
  for (pfv::ContainerFace& face : container.faces) face.wall = wall;
  container.faces[*container.face_named(from)].boundary = pfv::Boundary::pressure(1.0);
  container.faces[*container.face_named(to)].boundary = pfv::Boundary::pressure(0.0);
  return container;
}

TEST(Containers, PoresAddUpToTheVolumeAndBasesToTheFaces) {
  for (const Case& one : all_containers()) {
    Random random(3);
    const pfv::PackingArrays packing = spheres_in(one.container, 150, 0.08, random);
    const Stages s = stages_of(packing, one.container);
    const double volume = pfv::volume_of(one.container);
    double cells = 0.0;
    for (const auto& cell : s.network.cell_vertices) cells += pfv::cell_volume(cell, s.spheres).volume;
    EXPECT_NEAR(cells / volume, 1.0, 1e-12) << one.name;
    EXPECT_NEAR(sum(s.throats.pore_volume) / volume, 1.0, 1e-12) << one.name;
    const pfv::ContainerGeometry geometry = pfv::geometry_of(one.container, one.container.lower);
    const pfv::Bases bases = bases_of(s);
    pfv::Matrix6Xd loads = pfv::Matrix6Xd::Zero(6, one.container.face_count());
    std::vector<double> areas(one.container.faces.size(), 0.0);
    for (int b = 0; b < bases.size(); ++b) {
      loads.col(bases.face[b]) += bases.load(b);
      areas[bases.face[b]] += bases.area[b];
    }
    for (std::size_t f = 0; f < areas.size(); ++f)
      EXPECT_NEAR(areas[f] / geometry.areas[f], 1.0, 1e-11) << one.name << " " << one.container.faces[f].name;
    EXPECT_LT((loads - geometry.loads).cwiseAbs().maxCoeff(), 1e-11) << one.name;
    EXPECT_LT(geometry.loads.topRows<3>().rowwise().sum().norm(), 1e-14) << one.name;
  }
}

TEST(Containers, ForcesAndFluxesBalance) {
  for (const Case& one : all_containers()) {
    Random random(4);
    const pfv::PackingArrays packing = spheres_in(one.container, 200, 0.07, random);
    const int last = one.container.face_count() - 1;
    const bool round = pfv::cylinder_of(one.container).has_value();
    pfv::Flow flow(driven(one.container, one.container.faces[0].name, one.container.faces[round ? 1 : last].name),
                   viscosity_one());
    flow.evaluate(packing.view());
    const pfv::Report report = flow.report();
    EXPECT_GT(report.inflow, 0.0) << one.name;
    EXPECT_LT(std::abs(report.mass_error), 1e-11) << one.name;
    EXPECT_LT(report.force_balance_error, 1e-11) << one.name;
  }
}

TEST(Containers, MomentsOfGrainsAndWallsBalance) {
  for (const Case& one : polyhedra()) {
    Random random(4);
    const pfv::PackingArrays packing = spheres_in(one.container, 200, 0.07, random);
    pfv::Container container = driven(one.container, one.container.faces[0].name, one.container.faces[1].name);
    container.faces[0].boundary = pfv::Boundary::pressure(11.0);  // 10 Pa in common
    container.faces[1].boundary = pfv::Boundary::pressure(10.0);
    pfv::Options options;
    options.torques = true;
    pfv::Flow flow(container, viscosity_one(), options);
    const pfv::Forces& forces = flow.evaluate(packing.view());
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    double largest = 0.0;
    for (Eigen::Index k = 0; k < packing.positions.cols(); ++k)
      moment += packing.positions.col(k).cross(forces.total.col(k)) + forces.torque.col(k);
    for (const pfv::FaceResult& face : flow.faces()) {
      ASSERT_TRUE(face.moment) << one.name;
      moment += *face.moment;
      largest = std::max(largest, face.moment->norm());
    }
    EXPECT_GT(largest, 0.1) << one.name;
    EXPECT_LT(moment.norm(), 1e-12 * largest) << one.name;
  }
}

/// By the reciprocal theorem the fluid turns a shell at rest, under a pressure of 1 at one end, as strongly as the shell,
/// turned at 1 rad/s, drives fluid in there. Each axis lies elsewhere: the moment is taken about it.
TEST(Containers, TheMomentOnAShellIsWhatItDrivesWhenItTurns) {
  for (const Case& one : cylinders()) {
    Random random(7);
    const pfv::PackingArrays packing = spheres_in(one.container, 200, 0.06, random);
    const pfv::Surface& shell = one.container.faces[2].surface;
    const pfv::Container still = driven(one.container, one.container.faces[0].name, one.container.faces[1].name);
    pfv::Flow flow(still, viscosity_one());
    flow.evaluate(packing.view());
    const pfv::FaceResult on_shell = flow.faces()[2];
    ASSERT_TRUE(on_shell.moment) << one.name;
    const Eigen::Vector3d force = on_shell.force_pressure + on_shell.force_viscous;
    const double torque = shell.axis.dot(*on_shell.moment - shell.point.cross(force));
    pfv::Container turning = still;
    turning.faces[0].boundary = pfv::Boundary::pressure(0.0);
    turning.faces[2].angular_velocity = shell.axis;
    turning.faces[2].pivot = shell.point;
    pfv::Flow driving(turning, viscosity_one());
    driving.evaluate(packing.view());
    EXPECT_GT(std::abs(torque), 1e-8) << one.name;
    // the torque is what is left of moments about the origin, which round to 1e-12 of them
    EXPECT_NEAR(driving.faces()[0].flux, torque, 1e-9 * std::abs(torque) + 1e-12 * on_shell.moment->norm()) << one.name;
  }
}

TEST(Containers, ACubeOfSixPlanesIsTheBox) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  pfv::Flow box(upward_box(pfv::Wall::no_slip), viscosity_one());
  const Eigen::Matrix3Xd expected = box.evaluate(packing.view()).total;
  pfv::Flow planes(driven(turned_cube(Eigen::Matrix3d::Identity()), "zlo", "zhi"), viscosity_one());
  EXPECT_LT((planes.evaluate(packing.view()).total - expected).cwiseAbs().maxCoeff(),
            1e-13 * expected.cwiseAbs().maxCoeff());
  EXPECT_NEAR(*planes.report().permeability / *box.report().permeability, 1.0, 1e-13);

  const Eigen::Matrix3d turn = some_turn();
  pfv::PackingArrays turned = packing;
  turned.positions = turn * packing.positions;
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry}) {
    pfv::Flow upright(upward_box(wall), viscosity_one());
    pfv::Flow oblique(driven(turned_cube(turn), "zlo", "zhi", wall), viscosity_one());
    const Eigen::Matrix3Xd one = turn * upright.evaluate(packing.view()).total;
    const Eigen::Matrix3Xd other = oblique.evaluate(turned.view()).total;
    EXPECT_LT((one - other).cwiseAbs().maxCoeff(), 1e-10 * one.cwiseAbs().maxCoeff());
    EXPECT_NEAR(*oblique.report().permeability / *upright.report().permeability, 1.0, 1e-10);
  }
}

TEST(Containers, FacesBehindTheOthersChangeNothing) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  const pfv::Container cube = driven(turned_cube(Eigen::Matrix3d::Identity()), "zlo", "zhi");
  pfv::Flow alone(cube, viscosity_one());
  std::vector<pfv::ContainerFace> faces = cube.faces;
  faces.insert(faces.begin() + 2, plane_face("lid", {0.0, 0.0, 1.0}, {0.0, 0.0, 1.3}));
  faces.push_back(plane_face("beyond an edge", {1.0, 1.0, 0.0}, {1.1, 1.1, 0.0}));
  faces.push_back(plane_face("beyond a corner", {-1.0, 1.0, 1.0}, {0.0, 1.2, 1.0}));
  for (const std::size_t idle : {2, 7, 8}) {
    EXPECT_THROW(pfv::container_of(faces), pfv::InputError);
    faces[idle].may_bound_nothing = true;
  }
  pfv::Flow more(pfv::container_of(faces), viscosity_one());
  const Eigen::Matrix3Xd expected = alone.evaluate(packing.view()).total;
  EXPECT_LT((more.evaluate(packing.view()).total - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
  EXPECT_NEAR(pfv::volume_of(more.container()) / pfv::volume_of(alone.container()), 1.0, 1e-14);
  EXPECT_LT(more.report().force_balance_error, 1e-13);
  EXPECT_EQ(more.face_forces()[2].norm(), 0.0);
  pfv::Container closing = more.container();
  closing.faces[8].may_bound_nothing = false;
  EXPECT_THROW(pfv::check(closing), pfv::InputError);
}

TEST(Containers, ATurnedCylinderIsTheSameCylinder) {
  const pfv::PackingArrays packing = data_packing("cyl_equal_packing.csv");
  const Eigen::Matrix3d turn = some_turn();
  const Eigen::Vector3d shift(3.0, -5.0, 2.0);
  pfv::PackingArrays turned = packing;
  turned.positions = (turn * packing.positions).colwise() + shift;
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry}) {
    pfv::Flow upright(driven(cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 0.75), "bottom", "top", wall), viscosity_one());
    pfv::Flow oblique(driven(cylinder(turn.col(2), shift, 0.5, 0.75), "bottom", "top", wall), viscosity_one());
    const Eigen::Matrix3Xd one = turn * upright.evaluate(packing.view()).total;
    const Eigen::Matrix3Xd other = oblique.evaluate(turned.view()).total;
    EXPECT_LT((one - other).cwiseAbs().maxCoeff(), 1e-10 * one.cwiseAbs().maxCoeff());
    EXPECT_NEAR(*oblique.report().permeability / *upright.report().permeability, 1.0, 1e-10);
  }
}

// What all share: a translation moves no fluid in any pore, and a uniform expansion opens each by its volume.
TEST(Containers, RatesOfTranslationAndExpansionAreExactPoreByPore) {
  for (const Case& one : all_containers()) {
    Random random(5);
    const pfv::PackingArrays packing = spheres_in(one.container, 120, 0.06, random);
    pfv::Container moved = one.container;
    for (pfv::ContainerFace& face : moved.faces) {
      face.wall = pfv::Wall::symmetry;
      face.velocity = {0.3, -0.7, 1.1};
    }
    const Stages s = stages_of(packing, moved);
    const Eigen::Map<const Eigen::VectorXd> volumes(s.throats.pore_volume.data(), s.network.pores());
    const Eigen::Vector3d shift(0.3, -0.7, 1.1);
    const Eigen::VectorXd still =
        reciprocal_rates(s, motion_of(shift.replicate(1, s.spheres.size()), moved));
    EXPECT_LT(still.cwiseAbs().maxCoeff(), 1e-12 * volumes.mean()) << one.name;
    if (pfv::cylinder_of(one.container)) continue;  // no rigid motion widens a cylinder
    for (pfv::ContainerFace& face : moved.faces)
      face.velocity = (face.surface.offset - face.surface.normal.dot(moved.lower)) * face.surface.normal;
    const Eigen::VectorXd grown = reciprocal_rates(s, motion_of(s.spheres.centres, moved));
    EXPECT_LT((grown - 3.0 * volumes).cwiseAbs().maxCoeff(), 1e-11 * volumes.maxCoeff()) << one.name;
  }
}

TEST(Containers, MovingTiltingAndTurningFacesSweepWhatTheVolumeChangesBy) {
  for (const Case& one : all_containers()) {
    Random random(6);
    const pfv::PackingArrays packing = spheres_in(one.container, 120, 0.06, random);
    for (int f = 0; f < one.container.face_count(); ++f) {
      const bool round = pfv::cylinder_of(one.container).has_value();
      pfv::Container moved = one.container;
      pfv::ContainerFace& face = moved.faces[f];
      if (face.surface.is_plane()) face.velocity = 0.4 * face.surface.normal;
      if (!round) {
        face.angular_velocity = {0.2, -0.5, 0.3};
        face.pivot = 0.5 * (moved.lower + moved.upper);
      } else {  // about its own axis
        face.angular_velocity = 2.0 * moved.faces[2].surface.axis;
        face.pivot = moved.faces[2].surface.point;
      }
      const Stages s = stages_of(packing, moved);
      const Eigen::Matrix3Xd still = Eigen::Matrix3Xd::Zero(3, s.spheres.size());
      constexpr double h = 1e-5;
      const double expected = (pfv::geometry_after(moved, h, moved.lower).volume -
                               pfv::geometry_after(moved, -h, moved.lower).volume) / (2.0 * h);
      EXPECT_NEAR(reciprocal_rates(s, motion_of(still, moved)).sum(), expected, 1e-9) << one.name << " face " << f;
    }
  }
}

/// Spheres of a random packing in the lower part of a cylinder about the z axis of the unit cube's middle.
pfv::PackingArrays partly_full(int seed) {
  const pfv::PackingArrays all = random_packing(400, 0.025, 0.045, seed);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < all.ids.size(); ++k) {
    const Eigen::Vector2d from = all.positions.col(k).head<2>() - Eigen::Vector2d(0.5, 0.5);
    if (from.norm() + all.radii[k] < 0.5 && from[1] + all.radii[k] < 0.15) chosen.push_back(k);
  }
  pfv::PackingArrays some;
  some.ids = all.ids(chosen);
  some.positions = all.positions(Eigen::all, chosen);
  some.radii = all.radii(chosen);
  return some;
}

// Two spheres, an end and the shell meet in two places, on either side of the cylinder; the cell's orientation says in
// which. Above a bed that fills a part of it the other one was taken: a pore was all but closed, and the explicit limit fell
// to 4e-5 of what it is.
TEST(Containers, APoreAtAnEndOfACylinderIsOnItsOwnSide) {
  pfv::Container drum = pfv::container_of({cylinder_face("shell", Eigen::Vector3d::UnitZ(), {0.5, 0.5, 0.0}, 0.5),
                                           plane_face("back", -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()),
                                           plane_face("front", Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ())});
  drum.faces[2].boundary = pfv::Boundary::pressure(0.0);
  int seen = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const pfv::PackingArrays packing = partly_full(seed);
    pfv::Flow flow(drum, viscosity_one());
    flow.evaluate(packing.view());
    const pfv::PoreNetwork& network = flow.network();
    for (int c = 0; c < network.cells(); ++c) {
      const auto& cell = network.cell_vertices[c];
      if (!pfv::is_wall(cell[2])) continue;
      const Eigen::Vector3d centre = network.cell_centres.col(c) + network.origin;
      const auto outward = [&](pfv::Vertex wall) { return drum.faces[pfv::wall_number(wall)].surface.outward_at(centre); };
      const Eigen::Vector3d between = packing.positions.col(cell[1]) - packing.positions.col(cell[0]);
      EXPECT_GE(between.dot(outward(cell[2]).cross(outward(cell[3]))), 0.0) << "seed " << seed << " cell " << c;
      ++seen;
    }
  }
  EXPECT_GT(seen, 200);
}

TEST(Containers, TwoFacesOnOnePlaneAreRefused) {
  pfv::Container cube = turned_cube(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix());
  cube.faces.push_back(cube.faces[2]);
  cube.faces.back().name = "again";
  try {
    pfv::check(cube);
    FAIL();
  } catch (const pfv::InputError& error) {
    EXPECT_STREQ(error.what(), "container: faces ylo and again are the same plane; leave one of them out");
  }
}

TEST(Containers, ANoSlipShellThatTurnsTakesTheGrainsAlong) {
  Random random(7);
  pfv::Container drum = cylinder({0, 1, 0}, {0, 0, 0}, 0.5, 0.8);
  const pfv::PackingArrays packing = spheres_in(drum, 250, 0.06, random);
  drum.faces[0].boundary = drum.faces[1].boundary = pfv::Boundary::pressure(0.0);
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry}) {
    drum.faces[2].wall = wall;
    drum.faces[2].angular_velocity.setZero();
    pfv::Flow flow(drum, viscosity_one());
    EXPECT_EQ(flow.evaluate(packing.view()).total.norm(), 0.0);
    drum.faces[2].angular_velocity = Eigen::Vector3d::UnitY();
    flow.set_container(drum);
    const pfv::Forces& forces = flow.evaluate(packing.view());
    double torque = 0.0;
    for (Eigen::Index k = 0; k < packing.positions.cols(); ++k)
      torque += packing.positions.col(k).cross(forces.total.col(k)).y();
    if (wall == pfv::Wall::no_slip) EXPECT_GT(torque, 1e-6);
    else EXPECT_NEAR(torque, 0.0, 1e-14);
    EXPECT_NEAR(flow.report().volume_rate_sum, 0.0, 1e-14);
  }
}

// Turned with the cube, a patch is that of the box: its block cuts the same part out of the face.
TEST(Containers, APatchOnAnObliqueFaceIsThatOfTheBox) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  box.patches.push_back({pfv::Face::zhi, {-0.1, 0.6, -0.1, 1.1}, pfv::Boundary::pressure(0.0)});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
  pfv::Container cube = turned_cube(turn);
  cube.faces[4].boundary = pfv::Boundary::pressure(1.0);
  pfv::ContainerPatch patch;
  patch.face = 5;
  patch.upper[0] = (turn * Eigen::Vector3d(0.6, 0.0, 1.0))[0];  // lines of x = const. lie on the turned lid
  patch.boundary = pfv::Boundary::pressure(0.0);
  cube.patches.push_back(patch);
  pfv::PackingArrays turned = packing;
  turned.positions = turn * packing.positions;
  pfv::Flow upright(box, viscosity_one()), oblique(cube, viscosity_one());
  const Eigen::Matrix3Xd one = turn * upright.evaluate(packing.view()).total, other = oblique.evaluate(turned.view()).total;
  EXPECT_LT((one - other).cwiseAbs().maxCoeff(), 1e-10 * one.cwiseAbs().maxCoeff());
  EXPECT_LT(oblique.report().openings[0].flux, -1e-6);
}

TEST(Containers, APatchOpensAPartOfARoundWallAlone) {
  const pfv::PackingArrays packing = data_packing("cyl_equal_packing.csv");
  pfv::Container can = cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 0.75);
  const int shell = *can.face_named("shell");
  can.faces[0].boundary = pfv::Boundary::pressure(1.0);
  can.patches.push_back(pfv::patch_on(can, shell, {0.2, 0.6, -0.5, 0.5, 0.2, 0.6}, pfv::Boundary::pressure(0.0)));
  pfv::Flow flow(can, viscosity_one());
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  EXPECT_GT(report.openings[0].pores, 1);
  EXPECT_LT(report.openings[0].pores, 40);
  EXPECT_NEAR(report.openings[0].flux, -flow.faces()[0].flux, 1e-12 * flow.faces()[0].flux);
  EXPECT_LT(report.force_balance_error, 1e-12);
  const auto refused = [&](const std::vector<double>& bounds, int face, const std::string& what) {
    try {
      pfv::Container with = can;
      with.patches.push_back(pfv::patch_on(can, face, bounds, pfv::Boundary::sealed()));
      pfv::check(with);
      ADD_FAILURE() << what;
    } catch (const pfv::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused({-0.2, 0.2, -0.2, 0.2, 0.2, 0.6}, shell, "patch 2 on face shell: its block does not reach the face");
  refused({-0.2, 0.2, -0.2, 0.2}, shell, "a rectangle needs a plane normal to an axis");
  refused({0.2, -0.2, -0.2, 0.2}, 1, "flat, inverted");
  refused({0.2, 0.3}, 1, "the four numbers of a rectangle");
}

TEST(Containers, WhatCannotHoldFluidIsRefusedByName) {
  const auto refused = [](std::vector<pfv::ContainerFace> faces, const std::string& what) {
    try {
      const pfv::Container container = pfv::container_of(std::move(faces));
      pfv::check(container);
      ADD_FAILURE() << "accepted: " << what;
    } catch (const pfv::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  std::vector<pfv::ContainerFace> faces = wedge().faces;
  auto open = faces;
  open.erase(open.begin() + 4);
  refused(open, "open");
  auto twice = faces;
  twice[1].name = "x0";
  refused(twice, "occurs twice");
  auto idle = faces;
  idle.push_back(plane_face("far", {1.0, 0.0, 0.0}, {9.0, 0.0, 0.0}));
  refused(idle, "far");
  auto inside_out = faces;
  inside_out[5] = plane_face("top", {0.0, 0.0, -1.0}, {0.0, 0.0, 1.0});
  refused(inside_out, "turn its normal");
  refused({plane_face("bottom", {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}), plane_face("top", {0.1, 0.0, 1.0}, {0.0, 0.0, 1.0}),
           cylinder_face("shell", {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, 0.5)}, "not square");
  pfv::Options turning;
  turning.torques = true;
  EXPECT_THROW(pfv::Flow(cylinders()[0].container, viscosity_one(), turning), pfv::InputError);
  EXPECT_NO_THROW(pfv::Flow(wedge(), viscosity_one(), turning));
  const pfv::PackingArrays outside = packing_of({{0.9, 0.4, 0.9, 0.1}});
  try {
    pfv::Flow(wedge(), viscosity_one()).evaluate(outside.view());
    ADD_FAILURE();
  } catch (const pfv::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tilted"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace container_test
