// SPDX-License-Identifier: GPL-3.0-or-later
// Walls that are drawn: their polygons close around what the container holds, whatever its shape and place.
#include "pfv/io.hpp"
#include "problem/container_geometry.hpp"
#include "support/containers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace {

using namespace support;

struct Drawn {
  Eigen::Vector3d open = Eigen::Vector3d::Zero();  ///< sum of all area vectors, m²
  double volume = 0.0;                             ///< within, m³
  std::vector<Eigen::Vector3d> areas;              ///< area vector of each face, m²
  std::vector<int> polygons;                       ///< of each face
};

Drawn measure(const pfv::FieldGrid& grid, int faces) {
  Drawn drawn;
  drawn.areas.assign(faces, Eigen::Vector3d::Zero());
  drawn.polygons.assign(faces, 0);
  const pfv::Field& face = grid.of_cells.at(0);
  EXPECT_EQ(face.name, "face");
  const Eigen::Vector3d origin = grid.points.col(0);
  for (std::size_t cell = 0, begin = 0; cell < grid.ends.size(); begin = grid.ends[cell++]) {
    EXPECT_EQ(grid.types[cell], pfv::FieldGrid::polygon);
    const auto corner = [&](std::size_t i) { return Eigen::Vector3d(grid.points.col(grid.connectivity[i]) - origin); };
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t i = begin + 1; i + 1 < static_cast<std::size_t>(grid.ends[cell]); ++i)
      area += 0.5 * (corner(i) - corner(begin)).cross(corner(i + 1) - corner(begin));
    const int f = static_cast<int>(face.values(0, static_cast<Eigen::Index>(cell)));
    drawn.open += area;
    drawn.volume += corner(begin).dot(area) / 3.0;
    drawn.areas[f] += area;
    ++drawn.polygons[f];
  }
  return drawn;
}

TEST(WallsOutput, PolyhedraCloseAndHaveTheirFaces) {
  Random random(5);
  for (int number = 0; number < 300; ++number) {
    const pfv::Container container = random_polyhedron(random);
    const Drawn drawn = measure(pfv::grid_of_walls(container), container.face_count());
    const std::vector<double> areas = pfv::face_areas(container);
    const double whole = *std::max_element(areas.begin(), areas.end());
    EXPECT_LT(drawn.open.norm(), 1e-12 * whole) << number;
    EXPECT_NEAR(drawn.volume / pfv::volume_of(container), 1.0, 1e-12) << number;
    for (int f = 0; f < container.face_count(); ++f)
      EXPECT_LT((drawn.areas[f] - areas[f] * container.faces[f].surface.normal).norm(), 1e-12 * whole) << number;
  }
}

TEST(WallsOutput, CylindersAreStripsAndTwoPolygons) {
  Random random(6);
  for (int number = 0; number < 50; ++number) {
    const double radius = random(0.2, 2.0), length = random(0.2, 3.0);
    const pfv::Container container =
        cylinder(random.in_cube() + Eigen::Vector3d(0.01, 0.0, 0.0), random.in_cube(-5.0, 5.0), radius, length);
    const Drawn drawn = measure(pfv::grid_of_walls(container), container.face_count());
    const int strips = drawn.polygons[2];
    const double section = 0.5 * strips * std::sin(2.0 * pi / strips) * radius * radius;
    EXPECT_LT(drawn.open.norm(), 1e-12 * (section + radius * length));
    EXPECT_NEAR(drawn.volume / (section * length), 1.0, 1e-12);
    EXPECT_NEAR(drawn.volume / pfv::volume_of(container), 1.0, 1e-3);
    for (const int end : {0, 1}) {
      EXPECT_EQ(drawn.polygons[end], 1);
      EXPECT_LT((drawn.areas[end] - section * container.faces[end].surface.normal).norm(), 1e-12 * section);
    }
  }
}

TEST(WallsOutput, ATiltedCellHasTheWallsThatItDoesNotRepeatAcross) {
  pfv::Box box;
  box.lower = {1.0, -2.0, 0.5};
  box.upper = {3.0, 1.0, 2.0};
  box.periodic = {true, true, false};
  box.tilt = {0.6, 0.0, 0.0};
  const pfv::FieldGrid grid = pfv::grid_of_walls(box);
  const Drawn drawn = measure(grid, 6);
  EXPECT_EQ(grid.types.size(), 2u);
  EXPECT_LT((drawn.areas[4] + 6.0 * Eigen::Vector3d::UnitZ()).norm(), 1e-14);
  EXPECT_LT((drawn.areas[5] - 6.0 * Eigen::Vector3d::UnitZ()).norm(), 1e-14);
  EXPECT_EQ(grid.points.row(0).maxCoeff(), 3.6);  // the upper y side leans
}

TEST(WallsOutput, AFaceThatTurnsMovesWhereItIsDrawn) {
  pfv::Container container = cylinder({0, 0, 1}, {1, 2, 3}, 0.5, 2.0);
  container.faces[2].angular_velocity = {0.0, 0.0, 4.0};
  container.faces[2].pivot = {1, 2, 0};
  container.faces[1].velocity = {0.0, 0.0, -0.25};
  const pfv::FieldGrid grid = pfv::grid_of_walls(container);
  const pfv::Field& velocity = *std::find_if(grid.of_cells.begin(), grid.of_cells.end(),
                                             [](const pfv::Field& field) { return field.name == "velocity"; });
  EXPECT_EQ(velocity.values.col(0).norm(), 0.0);
  EXPECT_EQ(velocity.values.col(1), Eigen::Vector3d(0.0, 0.0, -0.25));
  for (Eigen::Index cell = 2; cell < velocity.values.cols(); ++cell)
    EXPECT_NEAR(velocity.values.col(cell).norm(), 4.0 * 0.5, 2e-3);
}

TEST(WallsOutput, StandsBesideFilesOfFieldsAlone) {
  EXPECT_EQ(pfv::walls_beside("a.b/flow.vtu"), "a.b/flow_walls.vtu");
  EXPECT_EQ(pfv::walls_beside("flow.pvtu"), "flow_walls.vtu");
  EXPECT_FALSE(pfv::walls_beside("/dev/stdout"));
  EXPECT_FALSE(pfv::walls_beside("a.vtu/flow"));
}

}  // namespace
