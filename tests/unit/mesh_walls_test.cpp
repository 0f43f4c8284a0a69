// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of triangle meshes: planes by coplanar groups, cylinders by flats around an axis.
#include "pfv/container.hpp"
#include "pfv/error.hpp"
#include "pfv/mesh_walls.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace mesh_walls_test {
namespace {

using pfv::MeshWall;
using pfv::RoundMeshes;
using pfv::Triangle;
using support::pi;
using Vector = Eigen::Vector3d;

/// As an STL file has it: seven digits.
Vector rounded(const Vector& x) { return x.cast<float>().cast<double>(); }

void add_quad(std::vector<Triangle>& mesh, const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  Triangle first, second;
  first << rounded(a), rounded(b), rounded(c);
  second << rounded(a), rounded(c), rounded(d);
  mesh.push_back(first);
  mesh.push_back(second);
}

Vector on_circle(double radius, double angle, double z) { return {radius * std::cos(angle), radius * std::sin(angle), z}; }

/// Flats from radius `below` at z = 0 to `above` at `height`, over a part of the way around, turned and moved.
std::vector<Triangle> funnel(int sides, double below, double above, double height, const Eigen::Isometry3d& place,
                             double turn = 1.0) {
  std::vector<Triangle> mesh;
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * pi * turn * i / sides, b = 2.0 * pi * turn * (i + 1) / sides;
    add_quad(mesh, place * on_circle(below, a, 0.0), place * on_circle(below, b, 0.0),
             place * on_circle(above, b, height), place * on_circle(above, a, height));
  }
  return mesh;
}

Eigen::Isometry3d somewhere() {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translate(Vector(0.3, -1.2, 2.0)).rotate(Eigen::AngleAxisd(0.7, Vector(1.0, 2.0, 3.0).normalized()));
  return place;
}

std::vector<MeshWall> walls_of(const std::vector<Triangle>& mesh, RoundMeshes round = RoundMeshes::as_cylinders) {
  return pfv::walls_of_mesh(mesh, round, "the mesh ");
}

TEST(MeshWalls, AnOpenHopperIsItsPlanesWithTheMeshOnTheirInnerSide) {
  const std::vector<Triangle> mesh = funnel(4, 0.1, 0.5, 0.6, somewhere());
  const std::vector<MeshWall> walls = walls_of(mesh);
  ASSERT_EQ(walls.size(), 4u);
  for (std::size_t w = 0; w < 4; ++w) {
    EXPECT_EQ(walls[w].triangles, (std::vector<int>{2 * static_cast<int>(w), 2 * static_cast<int>(w) + 1}));
    EXPECT_LT(walls[w].deviation, 1e-6);
    // the axis of the funnel, at half its height: (0.1 + 0.5) / 2 cos 45 from the flats but for their slope
    const double slope = 0.4 * std::sqrt(0.5) / 0.6;
    EXPECT_NEAR(walls[w].surface.distance(somewhere() * Vector(0.0, 0.0, 0.3)),
                0.3 * std::sqrt(0.5) / std::hypot(1.0, slope), 1e-6);
  }
}

TEST(MeshWalls, FlatsAroundAnAxisAreTheCylinderOfTheirCrossSection) {
  for (const int sides : {16, 32, 200, 1000}) {
    const std::vector<Triangle> mesh = funnel(sides, 0.25, 0.25, 1.0, somewhere());
    const std::vector<MeshWall> walls = walls_of(mesh);
    ASSERT_EQ(walls.size(), 1u) << sides;
    const pfv::Surface& shell = walls[0].surface;
    ASSERT_FALSE(shell.is_plane());
    const double section = 0.5 * sides * 0.25 * 0.25 * std::sin(2.0 * pi / sides);
    EXPECT_NEAR(pi * shell.radius * shell.radius, section, 2e-6 * section) << sides;
    EXPECT_NEAR(std::abs(shell.axis.dot(somewhere().linear().col(2))), 1.0, 1e-10);
    EXPECT_NEAR(shell.distance(somewhere() * Vector(0.0, 0.0, 0.7)), shell.radius, 1e-6);
    EXPECT_NEAR(walls[0].deviation, shell.radius - 0.25 * std::cos(pi / sides), 0.25 - shell.radius + 1e-6) << sides;
    // more than a container can have become 32
    EXPECT_EQ(walls_of(mesh, RoundMeshes::as_flats).size(), static_cast<std::size_t>(sides > 60 ? 32 : sides));
  }
}

TEST(MeshWalls, ADrumWithItsEndsIsACylinderAndTwoPlanes) {
  std::vector<Triangle> mesh = funnel(40, 0.25, 0.25, 1.0, somewhere());
  for (const double z : {0.0, 1.0})
    for (int i = 0; i < 40; ++i) {
      Triangle wedge;
      wedge << rounded(somewhere() * Vector(0.0, 0.0, z)), rounded(somewhere() * on_circle(0.25, 2.0 * pi * i / 40, z)),
          rounded(somewhere() * on_circle(0.25, 2.0 * pi * (i + 1) / 40, z));
      mesh.push_back(wedge);
    }
  const std::vector<MeshWall> walls = walls_of(mesh);
  ASSERT_EQ(walls.size(), 3u);
  EXPECT_FALSE(walls[0].surface.is_plane());
  EXPECT_NEAR(walls[1].surface.distance(somewhere() * Vector(0.0, 0.0, 0.4)), 0.4, 1e-6);
  EXPECT_NEAR(walls[2].surface.distance(somewhere() * Vector(0.0, 0.0, 0.4)), 0.6, 1e-6);
}

TEST(MeshWalls, WhatIsNotRoundStaysFlat) {
  EXPECT_EQ(walls_of(funnel(15, 0.25, 0.25, 1.0, somewhere())).size(), 15u);              // few flats
  EXPECT_EQ(walls_of(funnel(24, 0.25, 0.35, 1.0, somewhere())).size(), 24u);              // a cone
  EXPECT_EQ(walls_of(funnel(20, 0.25, 0.25, 1.0, somewhere(), 0.5)).size(), 20u);         // half a pipe
  std::vector<Triangle> oval = funnel(32, 0.25, 0.25, 1.0, Eigen::Isometry3d::Identity());
  for (Triangle& triangle : oval) triangle.row(0) *= 1.2;
  EXPECT_EQ(walls_of(oval).size(), 32u);
}

TEST(MeshWalls, AMeshThatIsNotConvexIsRefusedWithTheTriangle) {
  std::vector<Triangle> mesh = funnel(4, 0.5, 0.5, 1.0, Eigen::Isometry3d::Identity());
  add_quad(mesh, {0.1, -0.2, 0.2}, {0.1, 0.2, 0.2}, {0.1, 0.2, 0.8}, {0.1, -0.2, 0.8});  // a baffle
  try {
    walls_of(mesh);
    FAIL();
  } catch (const pfv::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the mesh is not convex: its triangle 1 reaches beyond the plane of triangle 9"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(walls_of({}), pfv::InputError);
  std::vector<Triangle> ball;  // many planes
  for (int i = 1; i < 60; ++i)
    for (const Triangle& triangle : funnel(80, std::sin(pi * i / 60), std::sin(pi * (i + 1) / 60), 0.05, Eigen::Isometry3d::Identity()))
      ball.push_back(triangle.array() + 0.001 * i * i);
  EXPECT_THROW(walls_of(ball), pfv::InputError);
  EXPECT_THROW(walls_of({Triangle::Zero()}), pfv::InputError);
}

/// A tube in bands, each turned by half a step against the one below: no two triangles lie on one plane.
std::vector<Triangle> remeshed_tube(int around, int bands, double radius, double height, const Eigen::Isometry3d& place) {
  std::vector<Triangle> mesh;
  const double half = pi / around;
  for (int band = 0; band < bands; ++band)
    for (int i = 0; i < around; ++i) {
      const double z = height * band / bands, above = height * (band + 1) / bands, a = (2 * i + band) * half;
      Triangle first, second;
      first << rounded(place * on_circle(radius, a, z)), rounded(place * on_circle(radius, a + 2 * half, z)),
          rounded(place * on_circle(radius, a + half, above));
      second << rounded(place * on_circle(radius, a + half, above)), rounded(place * on_circle(radius, a + 2 * half, z)),
          rounded(place * on_circle(radius, a + 3 * half, above));
      mesh.push_back(first);
      mesh.push_back(second);
    }
  return mesh;
}

TEST(MeshWalls, ARemeshedTubeIsACylinder) {
  const std::vector<Triangle> mesh = remeshed_tube(26, 24, 0.035, 0.35, somewhere());
  std::vector<MeshWall> walls = walls_of(mesh);
  ASSERT_EQ(walls.size(), 1u);
  const Vector axis = somewhere().linear() * Vector::UnitZ();
  EXPECT_NEAR(std::abs(walls[0].surface.axis.dot(axis)), 1.0, 1e-10);
  EXPECT_NEAR(pfv::Surface::cylinder(axis, walls[0].surface.point, 1.0).distance(somewhere() * Vector(0.0, 0.0, 9.0)), 1.0, 1e-5);
  const double section = 13.0 * std::sin(pi / 13.0);  // of 26 flats, over the square of the radius of their corners
  EXPECT_NEAR(walls[0].surface.radius / (0.035 * std::sqrt(section / pi)), 1.0, 2e-3);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(Vector(1.0, 2.0, 3.0)).rotate(Eigen::AngleAxisd(0.4, Vector::UnitX()));
  std::vector<MeshWall> flats = walls_of(mesh, RoundMeshes::as_flats);
  ASSERT_EQ(flats.size(), 32u);
  const Vector before = flats[5].surface.normal;
  std::vector<Triangle> moved;
  for (const Triangle& triangle : mesh) moved.emplace_back((motion.linear() * triangle).colwise() + Vector(motion.translation()));
  pfv::follow_mesh(flats[5], moved, true);
  EXPECT_LT((flats[5].surface.normal - motion.linear() * before).norm(), 1e-12);
}

TEST(MeshWalls, ASiloOfManyFlatsHasFewerAndItsVolume) {
  std::vector<Triangle> mesh = funnel(82, 0.02, 0.135, 0.2, somewhere());
  Eigen::Isometry3d above = somewhere();
  above.translate(Vector(0.0, 0.0, 0.2));
  for (const Triangle& triangle : funnel(82, 0.135, 0.135, 0.2, above)) mesh.push_back(triangle);
  const std::vector<MeshWall> walls = walls_of(mesh);
  ASSERT_EQ(walls.size(), 48u);
  std::vector<pfv::ContainerFace> faces;
  const auto add = [&](const pfv::Surface& surface) {
    faces.emplace_back();
    faces.back().name = std::to_string(faces.size());
    faces.back().surface = surface;
  };
  for (const MeshWall& wall : walls) add(wall.surface);
  for (const double z : {0.0, 0.4}) add(pfv::Surface::plane(somewhere().linear() * Vector(0.0, 0.0, z > 0.0 ? 1.0 : -1.0), somewhere() * Vector(0.0, 0.0, z)));
  const double polygon = 41.0 * std::sin(pi / 41.0);
  const double volume = polygon * (0.135 * 0.135 * 0.2 + 0.2 / 3.0 * (0.135 * 0.135 + 0.135 * 0.02 + 0.02 * 0.02));
  EXPECT_NEAR(pfv::volume_of(pfv::container_of(faces)) / volume, 1.0057, 1e-3);  // 24 flats around a circle: tan(pi/24) / (pi/24)
}

TEST(MeshWalls, FollowAMotion) {
  const std::vector<Triangle> mesh = funnel(40, 0.25, 0.25, 1.0, Eigen::Isometry3d::Identity());
  std::vector<Triangle> moved = mesh;
  for (Triangle& triangle : moved) triangle = somewhere() * triangle;
  for (const RoundMeshes round : {RoundMeshes::as_cylinders, RoundMeshes::as_flats})
    for (const MeshWall& wall : walls_of(mesh, round)) {
      MeshWall now = wall;
      pfv::follow_mesh(now, moved, round == RoundMeshes::as_flats);
      const Vector place(0.1, 0.05, 0.3);
      EXPECT_NEAR(now.surface.distance(somewhere() * place), wall.surface.distance(place), 1e-7);
    }
}

}  // namespace
}  // namespace mesh_walls_test
