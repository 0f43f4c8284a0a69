// SPDX-License-Identifier: GPL-3.0-or-later
// Containers that are not boxes against Stokes flow by finite elements (Taylor-Hood on curved tetrahedra, errors of
// 0.2 to 0.3 % in K): equal spheres in a cylinder, R/r 3.8, in prisms of its size, and in a wedge whose side leans by 25
// degrees. doc/containers.py prints the table of doc/container.md.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/containers.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace container_test {
namespace {

using namespace support;

struct Case {
  std::string name, wall;
  pfv::Container container;
  double ratio, median, worst;  ///< what was measured: K over that of finite elements, error of a force over the force
};

std::vector<Case> cases() {
  const pfv::Container round = cylinder({0, 0, 1}, {0, 0, 0}, 0.5, 0.75);
  return {{"cylinder", "no_slip", round, 0.987, 0.042, 0.080},
          {"cylinder", "symmetry", round, 0.992, 0.037, 0.079},
          {"wedge", "no_slip", wedge(), 1.003, 0.061, 0.132},
          {"8 sides around", "no_slip", prism(8, 0.5, 0.75), 1.024, 0.051, 0.094},
          {"8 sides of equal area", "no_slip", prism(8, 0.4868417219611832, 0.75), 0.981, 0.056, 0.248},
          {"16 sides around", "no_slip", prism(16, 0.5, 0.75), 1.034, 0.040, 0.071},
          {"16 sides of equal area", "no_slip", prism(16, 0.4967685077007135, 0.75), 1.023, 0.039, 0.072}};
}

const Row& reference(const std::vector<Row>& rows, const Case& one) {
  for (const Row& row : rows)
    if (row.at("case") == one.name && row.at("wall") == one.wall) return row;
  throw std::runtime_error("no reference for " + one.name);
}

/// Errors of the forces over them, ascending.
std::vector<double> errors_of(const Eigen::Matrix3Xd& forces, const pfv::PackingArrays& packing,
                              const std::string& reference) {
  std::vector<double> errors;
  for (const Row& row : table(reference))
    for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
      if (packing.ids[k] == static_cast<std::int64_t>(number(row, "id"))) {
        const Eigen::Vector3d exact(number(row, "fx"), number(row, "fy"), number(row, "fz"));
        errors.push_back((forces.col(k) - exact).norm() / exact.norm());
      }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(StokesInContainers, PermeabilityAndForces) {
  const std::vector<Row> references = table("containers_permeability.csv");
  ASSERT_EQ(references.size(), cases().size());
  for (const Case& one : cases()) {
    const Row& exact = reference(references, one);
    pfv::Container container = one.container;
    for (pfv::ContainerFace& face : container.faces) face.wall = pfv::named<pfv::Wall>(one.wall);
    container.faces[*container.face_named("bottom")].boundary = pfv::Boundary::pressure(1.0);
    container.faces[*container.face_named("top")].boundary = pfv::Boundary::pressure(0.0);
    const pfv::PackingArrays packing = data_packing(exact.at("packing"));
    pfv::Flow flow(container, viscosity_one());
    const Eigen::Matrix3Xd& forces = flow.evaluate(packing.view()).total;
    const double ratio = *flow.report().permeability / number(exact, "permeability");
    const std::vector<double> errors = errors_of(forces, packing, exact.at("forces"));
    ASSERT_EQ(static_cast<Eigen::Index>(errors.size()), packing.ids.size());
    const double median = errors[errors.size() / 2], worst = errors.back();
    std::printf("| %s | %s | %.3f | %.1f %% | %.1f %% |\n", one.name.c_str(), one.wall.c_str(), ratio, 100.0 * median,
                100.0 * worst);
    EXPECT_NEAR(ratio, one.ratio, 1e-3) << one.name;
    EXPECT_NEAR(median, one.median, 1e-3) << one.name;
    EXPECT_NEAR(worst, one.worst, 1e-3) << one.name;
    EXPECT_GT(*flow.report().permeability_error, std::abs(ratio - 1.0)) << one.name;
  }
}

}  // namespace
}  // namespace container_test
