// SPDX-License-Identifier: GPL-3.0-or-later
// E = dV/dx (thesis eqs. 4.4-4.8): rates of the cells' volumes.
#include "physics/volume_rates.hpp"

#include "pfv/pfv.hpp"
#include "physics/cell_volumes.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/motions.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

namespace volume_rates_test {
namespace {

using namespace support;

Eigen::VectorXd volumes(const Stages& s) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(s.network.pores());
  for (int c = 0; c < s.network.cells(); ++c)
    result[s.network.cell_pore[c]] +=
        pfv::cell_volume(s.network.cell_vertices[c], s.spheres).volume;
  return result;
}

TEST(CellVolumes, FillTheBox) {
  for (const char* name : {"packing_100.csv", "packing_500.csv"}) {
    const Stages s = stages_of(data_packing(name), pfv::Box{});
    EXPECT_NEAR(volumes(s).sum(), 1.0, 1e-14);
    EXPECT_GT(volumes(s).minCoeff(), 0.0);
  }
}

TEST(CellVolumes, AreThePyramidsOfTheThroats) {
  const Stages s = stages_of(data_packing("packing_500.csv"), pfv::Box{});
  const Eigen::VectorXd volume = volumes(s);
  for (int p = 0; p < s.network.pores(); ++p)
    EXPECT_NEAR(s.throats.pore_volume[p], volume[p], 1e-15);
}

// A uniform stretch along the axes scales every cell, whatever walls it stands on.
TEST(VolumeRates, UniformStretchGivesItsTraceTimesEachVolume) {
  pfv::Box box;
  box.lower = {-0.3, 0.1, 2.0};
  box.upper = {0.9, 1.2, 2.8};
  const Stages s = stages_of(random_packing(200, 0.03, 0.06, 11, box), box);
  const Eigen::Vector3d stretch(0.3, -0.7, 1.1), shift(0.4, -2.0, 0.3);
  const auto velocity = [&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(stretch.cwiseProduct(x) + shift);
  };
  pfv::Box moving = box;
  for (const pfv::Face face : pfv::all_faces)
    moving[face].velocity = stretch[pfv::axis_of(face)] * box.position(face) +
                            shift[pfv::axis_of(face)];
  Eigen::Matrix3Xd velocities(3, s.spheres.size());
  for (int k = 0; k < s.spheres.size(); ++k)
    velocities.col(k) = velocity(box.lower + s.spheres.centres.col(k));
  const Eigen::VectorXd rate = geometric_rates(s, velocities, moving), volume = volumes(s);
  for (int p = 0; p < s.network.pores(); ++p)
    EXPECT_NEAR(rate[p], stretch.sum() * volume[p], 1e-14);
  EXPECT_NEAR(rate.sum() / (stretch.sum() * box.volume()), 1.0, 1e-12);
}

// A tetrahedron scales with the trace of any affine field.
TEST(VolumeRates, AffineFieldGivesItsTraceTimesTheVolumeOfInnerCells) {
  const Stages s = stages_of(random_packing(200, 0.03, 0.06, 11), pfv::Box{});
  Eigen::Matrix3d a;
  a << 0.3, 1.2, -0.4, 0.9, -0.5, 0.2, -1.1, 0.6, 0.8;
  const Eigen::Matrix3Xd velocities =
      (a * s.spheres.centres).colwise() + Eigen::Vector3d(1.0, -2.0, 0.5);
  const Eigen::VectorXd rate = geometric_rates(s, velocities, pfv::Box{});
  int inner = 0;
  for (int c = 0; c < s.network.cells(); ++c) {
    const auto& cell = s.network.cell_vertices[c];
    if (pfv::is_wall(cell[3])) continue;
    // random places: no cell is merged with another
    EXPECT_NEAR(rate[s.network.cell_pore[c]], a.trace() * pfv::cell_volume(cell, s.spheres).volume, 1e-15);
    ++inner;
  }
  EXPECT_GT(inner, 500);
}

TEST(VolumeRates, SumIsTheRateOfTheBoxForAnyMotionOfTheGrains) {
  const Stages s = stages_of(data_packing("packing_500.csv"), pfv::Box{});
  Random random(4);
  Eigen::Matrix3Xd velocities(3, s.spheres.size());
  for (int k = 0; k < s.spheres.size(); ++k) velocities.col(k) = random.in_cube();
  pfv::Box box;
  EXPECT_NEAR(geometric_rates(s, velocities, box).sum(), 0.0, 1e-13);
  box[pfv::Face::xlo].velocity = -0.25;
  box[pfv::Face::yhi].velocity = -0.5;
  box[pfv::Face::zhi].velocity = 0.125;
  EXPECT_NEAR(geometric_rates(s, velocities, box).sum(), 0.25 - 0.5 + 0.125, 1e-13);
}

/// `spheres` with vertex v displaced along an axis; a wall is displaced along its own axis.
pfv::Spheres displaced(pfv::Spheres spheres, pfv::Vertex v, int axis, double by) {
  if (!pfv::is_wall(v)) {
    spheres.centres(axis, v) += by;
  } else {
    pfv::Surface& plane = spheres.walls[pfv::wall_number(v)].surface;
    plane.offset += by * plane.normal[axis];
  }
  return spheres;
}

// Each volume is linear in one coordinate of one vertex, so central differences are exact.
TEST(VolumeRates, GradientsAreTheFiniteDifferencesOfEveryKindOfCell) {
  const Stages s = stages_of(random_packing(12, 0.08, 0.12, 2), pfv::Box{});
  std::array<int, 4> kinds{};
  for (const auto& cell : s.network.cell_vertices) {
    const pfv::CellVolume volume = pfv::cell_volume(cell, s.spheres);
    int walls = 0;
    for (int i = 0; i < 4; ++i) {
      walls += pfv::is_wall(cell[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const bool wall = pfv::is_wall(cell[i]);
        if (wall && pfv::wall_number(cell[i]) / 2 != axis) continue;
        const double h = 0.01;
        const double difference =
            (pfv::cell_volume(cell, displaced(s.spheres, cell[i], axis, h)).volume -
             pfv::cell_volume(cell, displaced(s.spheres, cell[i], axis, -h)).volume) /
            (2.0 * h);
        EXPECT_NEAR(volume.gradient[i][axis], difference, 1e-14);
      }
    }
    ++kinds[walls];
  }
  for (const int kind : kinds) EXPECT_GT(kind, 0);
}

TEST(BaseAreas, FillEachFaceWithBothPoresOfAnEdge) {
  const Stages s = stages_of(data_packing("packing_100.csv"), pfv::Box{});
  const auto areas = bases_of(s).area;
  std::array<double, 6> sum{};
  for (std::size_t c = 0; c < areas.size(); ++c) sum[s.boundaries.contacts[c].face] += areas[c];
  for (const double area : sum) EXPECT_NEAR(area, 1.0, 1e-14);
}

/// All ways to drain a piston that balance must not depend on.
std::vector<pfv::Box> drained_pistons() {
  std::vector<pfv::Box> boxes;
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry})
    for (int drain = 0; drain < 4; ++drain) {
      pfv::Box box;
      for (const pfv::Face face : pfv::all_faces) box[face].wall = wall;
      box[pfv::Face::zhi].velocity = -1.0;
      if (drain == 0) box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(3.0);
      if (drain == 1) box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(-2.0);
      if (drain == 2) {
        box[pfv::Face::xlo].boundary = pfv::Boundary::pressure(1.0);
        box[pfv::Face::zhi].boundary = pfv::Boundary::flux(0.3);
      }
      if (drain == 3) {
        pfv::Patch patch;
        patch.face = pfv::Face::yhi;
        patch.rectangle = {0.4, 0.6, 0.4, 0.6};
        patch.boundary = pfv::Boundary::pressure(0.0);
        box.patches.push_back(patch);
      }
      boxes.push_back(box);
    }
  return boxes;
}

TEST(Pistons, LoseWhatTheyDisplaceThroughEveryKindOfBoundary) {
  for (const pfv::Box& box : drained_pistons()) {
    pfv::PackingArrays packing = random_packing(100, 0.04, 0.08, 6);
    Random random(9);
    packing.velocities.resize(3, packing.positions.cols());
    for (int k = 0; k < packing.radii.size(); ++k) packing.velocities.col(k) = random.in_cube();
    pfv::Flow flow(box, viscosity_one());
    flow.evaluate(packing.view());
    const pfv::Report report = flow.report();
    EXPECT_NEAR(report.volume_rate_sum, -1.0, 1e-12);
    // round-off of p in the shortest throats: measured at most 1.3e-12
    EXPECT_LT(std::abs(report.mass_error), 2e-15);
    EXPECT_LT(report.force_balance_error, 1e-13);
    double net = 0.0;
    for (const pfv::FaceResult& face : report.faces) net += face.flux;
    EXPECT_NEAR(net, -1.0, 1e-11);
  }
}

}  // namespace
}  // namespace volume_rates_test
