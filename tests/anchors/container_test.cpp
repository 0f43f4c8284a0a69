// SPDX-License-Identifier: GPL-3.0-or-later
// Containers that are not boxes against Stokes flow by finite elements (Taylor-Hood on curved tetrahedra, errors of
// 0.2 to 0.3 % in K): equal spheres in a cylinder, R/r 3.8, and in a wedge whose side leans by 25 degrees.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/containers.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace {

using namespace support;

struct Case {
  std::string name, packing, forces;
  pfv::Container container;
  pfv::Wall wall;
  double permeability;  ///< m², by finite elements
};

std::vector<Case> cases() {
  const pfv::Container round = cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 0.75);
  return {{"cylinder, no slip", "cyl_equal_packing.csv", "cyl_equal_noslip_forces.csv", round, pfv::Wall::no_slip,
           1.84923816e-4},
          {"cylinder, free slip", "cyl_equal_packing.csv", "cyl_equal_symmetry_forces.csv", round,
           pfv::Wall::symmetry, 3.00891201e-4},
          {"wedge", "wedge_packing.csv", "wedge_noslip_forces.csv", wedge(), pfv::Wall::no_slip, 1.05111197e-4}};
}

}  // namespace

TEST(StokesInContainers, PermeabilityAndForces) {
  for (const Case& one : cases()) {
    pfv::Container container = one.container;
    for (pfv::ContainerFace& face : container.faces) face.wall = one.wall;
    container.faces[*container.face_named("bottom")].boundary = pfv::Boundary::pressure(1.0);
    container.faces[*container.face_named("top")].boundary = pfv::Boundary::pressure(0.0);
    const pfv::PackingArrays packing = data_packing(one.packing);
    pfv::Flow flow(container, viscosity_one());
    const Eigen::Matrix3Xd& forces = flow.evaluate(packing.view()).total;
    EXPECT_NEAR(*flow.report().permeability / one.permeability, 1.0, 0.02) << one.name;
    EXPECT_GT(*flow.report().permeability_error, 0.02) << one.name;
    std::vector<double> errors;
    for (const Row& row : table(one.forces))
      for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
        if (packing.ids[k] == static_cast<std::int64_t>(number(row, "id"))) {
          const Eigen::Vector3d exact(number(row, "fx"), number(row, "fy"), number(row, "fz"));
          errors.push_back((forces.col(k) - exact).norm() / exact.norm());
        }
    ASSERT_EQ(static_cast<Eigen::Index>(errors.size()), packing.ids.size());
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.07) << one.name;
    EXPECT_LT(errors.back(), 0.15) << one.name;
  }
}
