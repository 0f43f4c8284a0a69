// SPDX-License-Identifier: GPL-3.0-or-later
// Many planes in the place of an edge or of a round wall: the flow hardly knows how many.
#include "pfv/container.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "support/boxes.hpp"
#include "support/containers.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace obtuse_edges_test {
namespace {

using namespace support;

/// Pressure 1 at face `from`, 0 at face `to`.
pfv::Container driven(std::vector<pfv::ContainerFace> faces, const std::string& from, const std::string& to,
                      pfv::Wall wall) {
  for (pfv::ContainerFace& face : faces) {
    face.wall = wall;
    if (face.name == from) face.boundary = pfv::Boundary::pressure(1.0);
    if (face.name == to) face.boundary = pfv::Boundary::pressure(0.0);
  }
  return pfv::container_of(faces);
}

/// The unit cube, its four edges along z rounded to a radius by so many planes each.
std::vector<pfv::ContainerFace> bevelled_cube(double radius, int planes) {
  std::vector<pfv::ContainerFace> faces = turned_cube(Eigen::Matrix3d::Identity()).faces;
  for (int edge = 0; edge < 4; ++edge)
    for (int i = 1; i <= planes; ++i) {
      const double angle = 0.5 * pi * (edge + i / (planes + 1.0));
      const Eigen::Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
      const Eigen::Vector3d corner(edge == 0 || edge == 3 ? 1.0 : 0.0, edge < 2 ? 1.0 : 0.0, 0.0);
      const Eigen::Vector3d inwards(corner.x() > 0.5 ? -radius : radius, corner.y() > 0.5 ? -radius : radius, 0.0);
      faces.push_back(plane_face("bevel " + std::to_string(edge) + std::to_string(i), normal,
                                 corner + inwards + radius * normal));
    }
  return faces;
}

// What a bevel takes away of a kite's area is of the order of its radius. Pieces of kites on their own made it 10 %.
TEST(ObtuseEdges, BevelledEdgesOfABoxAreItsEdges) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  for (const pfv::Wall wall : {pfv::Wall::symmetry, pfv::Wall::no_slip}) {
    pfv::Flow box(driven(bevelled_cube(0.0, 0), "zlo", "zhi", wall), viscosity_one());
    const Eigen::Matrix3Xd expected = box.evaluate(packing.view()).total;
    for (const int planes : {1, 3, 5})
      for (const double radius : {1e-6, 1e-3}) {
        SCOPED_TRACE(std::to_string(planes) + " planes, radius " + std::to_string(radius));
        pfv::Flow bevelled(driven(bevelled_cube(radius, planes), "zlo", "zhi", wall), viscosity_one());
        const Eigen::Matrix3Xd forces = bevelled.evaluate(packing.view()).total;
        const double within = 3.0 * radius + 1e-8;
        // pieces keep pressures of their own, which differ a little along the edge
        EXPECT_LT((forces - expected).cwiseAbs().maxCoeff(), (4e-3 + 30.0 * within) * expected.cwiseAbs().maxCoeff());
        EXPECT_NEAR(*bevelled.report().permeability / *box.report().permeability, 1.0, within);
        EXPECT_LT(bevelled.report().force_balance_error, 1e-12);
        EXPECT_LT(std::abs(bevelled.report().mass_error), 1e-12);
      }
  }
}

// Five such planes never came to an end.
TEST(ObtuseEdges, AFaceAsNarrowAsRoundingIsRefused) {
  for (const int planes : {1, 5}) {
    try {
      pfv::container_of(bevelled_cube(1e-9, planes));
      FAIL() << planes;
    } catch (const pfv::InputError& problem) {
      EXPECT_NE(std::string(problem.what()).find("face bevel 01 is a strip"), std::string::npos) << problem.what();
    }
  }
}

// The triangulation places walls to a few 1e-9 of the box, and may not see one of two that meet at such an angle: its
// pressure was left out without a word.
TEST(ObtuseEdges, APressureActsOrIsRefused) {
  const pfv::PackingArrays packing = data_packing("packing_100.csv");
  int refused = 0;
  for (const double angle : {1e-2, 1e-4, 1e-6, 1e-7, 3e-8, 1e-8, 4e-9}) {
    std::vector<pfv::ContainerFace> faces = bevelled_cube(0.0, 0);
    faces.push_back(plane_face("twin", {0.6 * angle, 0.8 * angle, 1.0}, {0.5, 0.5, 1.0}));
    pfv::Flow flow(driven(faces, "twin", "", pfv::Wall::no_slip), viscosity_one());
    try {
      flow.evaluate(packing.view());
      EXPECT_LT((flow.pore_pressures().array() - 1.0).abs().maxCoeff(), 1e-12) << angle;
    } catch (const pfv::InputError& problem) {
      ++refused;
      EXPECT_NE(std::string(problem.what()).find("face twin: its pressure has no pore to act on"), std::string::npos)
          << problem.what();
      EXPECT_LT(angle, 1e-5);
    }
  }
  EXPECT_GT(refused, 0);
}

// A loose bed: throats at the wall are wide, and much of their fluid is beyond the pyramids on their facets.
TEST(ObtuseEdges, FlatsConductWhatTheCylinderDoes) {
  const pfv::PackingArrays packing = data_packing("cylinder_loose_20.csv");
  for (const pfv::Wall wall : {pfv::Wall::symmetry, pfv::Wall::no_slip}) {
    pfv::Flow round(driven(cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 1.0).faces, "bottom", "top", wall), viscosity_one());
    round.evaluate(packing.view());
    for (const int flats : {16, 32, 60}) {
      pfv::Flow flats_around(driven(prism(flats, 0.5, 1.0).faces, "bottom", "top", wall), viscosity_one());
      flats_around.evaluate(packing.view());
      EXPECT_NEAR(*flats_around.report().permeability / *round.report().permeability, 1.0, 0.12) << flats;
    }
  }
}

}  // namespace
}  // namespace obtuse_edges_test
