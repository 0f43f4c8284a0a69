// SPDX-License-Identifier: GPL-3.0-or-later
// A point source in a dense packing against Darcy's law around it, p = q mu / (4 pi K r).
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"

#include <array>
#include <gtest/gtest.h>

namespace point_source_test {
namespace {

using namespace support;

constexpr double q = 1.0;

/// Permeability of the middle eighth of the cube: at its faces the packing is looser.
double inner_permeability(const pfv::PackingArrays& packing) {
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one());
  flow.evaluate(packing.view());
  const pfv::PoreNetwork& network = flow.network();
  const Eigen::Matrix3Xd velocities = flow.pore_velocities();
  const Eigen::VectorXd volumes = flow.pore_volumes();
  double discharge = 0.0;
  for (int pore = 0; pore < network.pores(); ++pore) {
    const Eigen::Vector3d place = network.origin + network.pore_centres.col(pore);
    if ((place.array() - 0.5).abs().maxCoeff() < 0.25)
      discharge += volumes[pore] * velocities(2, pore);
  }
  const double gradient = (flow.plane_pressure(2, 0.25) - flow.plane_pressure(2, 0.75)) / 0.5;
  return discharge / 0.125 / gradient;
}

TEST(PointSource, SpreadsLikeDarcyFlow) {
  const pfv::PackingArrays packing = pfv::dense_packing(5000);
  const double K = inner_permeability(packing);
  const Eigen::Vector3d source(0.5, 0.5, 0.5);
  const auto darcy = [&](double r) { return q / (4.0 * M_PI * K * r); };
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces)
    box[face].boundary = {pfv::Boundary::Kind::pressure, 0.0,
                          [&](const Eigen::Vector3d& place, double) {
                            return darcy((place - source).norm());
                          }};
  box.regions = {{source, source, pfv::Boundary::flux(q)}};
  pfv::Flow flow(box, viscosity_one());
  flow.evaluate(packing.view());

  // shells from four grain radii on; means over their pores: 1.016, 0.992, 0.982, 0.971, 0.970
  const double width = 0.06;
  std::array<double, 5> sum{}, count{};
  const pfv::PoreNetwork& network = flow.network();
  for (int pore = 0; pore < network.pores(); ++pore) {
    const double r = (network.origin + network.pore_centres.col(pore) - source).norm();
    const int shell = static_cast<int>((r - 0.1) / width);
    if (r < 0.1 || shell >= 5) continue;
    sum[shell] += flow.pore_pressures()[pore] / darcy(r);
    count[shell] += 1.0;
  }
  for (int shell = 0; shell < 5; ++shell) {
    EXPECT_NEAR(sum[shell] / count[shell], 1.0, 0.03) << "shell " << shell;
  }
}

}  // namespace
}  // namespace point_source_test
