// SPDX-License-Identifier: GPL-3.0-or-later
// Which strain of the pores leads to a new network.
#include "pfv/pfv.hpp"
#include "physics/conductances.hpp"
#include "physics/pore_strain.hpp"
#include "step/built_network.hpp"
#include "support/boxes.hpp"
#include "support/drained_piston.hpp"
#include "support/motions.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

namespace strain_measure_test {
namespace {

using namespace support;

constexpr double dt = 1e-3;

struct Piston : DrainedPiston {
  pfv::Flow flow(pfv::StrainMeasure measure) const {
    pfv::Options options;
    options.strain_measure = measure;
    return pfv::Flow(box, viscosity_one(), options);
  }
};

TEST(StrainMeasure, MeanIsTheSumOfAllChangesOverTheSumOfAllVolumes) {
  Piston piston;
  piston.sink(1.0);
  const Stages s = stages_of(piston.packing, piston.box);
  const Eigen::VectorXd rates =
      reciprocal_rates(s, motion_of(piston.packing.velocities, piston.box));
  double volume = 0.0;
  for (const double one : pfv::strain_volumes(s.network, s.throats, s.spheres)) volume += one;
  pfv::Flow flow = piston.flow(pfv::StrainMeasure::mean);
  flow.step(piston.packing.view(), dt);
  flow.step(piston.packing.view(), 2.0 * dt);
  EXPECT_NEAR(flow.strain() / (3.0 * dt * rates.cwiseAbs().sum() / volume), 1.0, 1e-12);
}

TEST(StrainMeasure, WhatIsUndoneDoesNotCountForTheMean) {
  for (const auto measure : {pfv::StrainMeasure::mean, pfv::StrainMeasure::largest}) {
    Piston piston;
    pfv::Flow flow = piston.flow(measure);
    for (const double rate : {1.0, -1.0}) {
      piston.sink(rate);
      flow.set_box(piston.box);
      flow.step(piston.packing.view(), dt);
    }
    if (measure == pfv::StrainMeasure::mean)
      EXPECT_LT(flow.strain(), 1e-15);
    else
      EXPECT_GT(flow.strain(), 2e-3);
  }
}

/// New networks while one grain of 60 flutters by a fifth of its radius and a pressure drives fluid past all.
std::int64_t networks_of_a_fluttering_grain(pfv::StrainMeasure measure) {
  Piston piston;
  piston.box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1e6);
  pfv::Flow flow = piston.flow(measure);
  for (int step = 0; step < 40; ++step) {
    const double direction = step / 10 % 2 == 0 ? 1.0 : -1.0;
    piston.packing.velocities(0, 5) = direction * 0.02 * piston.packing.radii[5] / dt;
    flow.step(piston.packing.view(), dt);
    piston.packing.positions += dt * piston.packing.velocities;
  }
  return flow.retriangulations();
}

TEST(StrainMeasure, OneGrainLeadsToNewNetworksByTheLargestStrainAlone) {
  EXPECT_GT(networks_of_a_fluttering_grain(pfv::StrainMeasure::largest), 10);
  EXPECT_LE(networks_of_a_fluttering_grain(pfv::StrainMeasure::mean), 1);
}

TEST(StrainMeasure, APoreThatAllFluidHasToPassCountsByThePowerLostThere) {
  Piston piston;
  const Stages s = stages_of(piston.packing, piston.box);
  const int pores = s.network.pores(), throats = s.network.throats();
  const std::vector<double> volumes(pores, 1.0);
  pfv::Conductances conductances;
  for (int t = 0; t < throats; ++t) conductances.value.push_back(1.0 + t % 7);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const auto [i, j] = s.network.throat_pores[throats / 2];
  ASSERT_NE(i, j);
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(pores);
  changes[i] = changes[j] = -0.1;
  // at rest: the mean over the space
  const double of_space = 0.2 / pores;
  EXPECT_NEAR(pfv::mean_pore_strain(s.network, conductances, Eigen::VectorXd::Zero(pores), none, changes,
                                    volumes), of_space, 1e-15);
  // all is lost around one of the two: half of each throat, and all of that between the two
  Eigen::VectorXd pressures = Eigen::VectorXd::Zero(pores);
  pressures[i] = 1.0;
  double lost = 0.0, strained = 0.0;
  for (int t = 0; t < throats; ++t) {
    const auto [a, b] = s.network.throat_pores[t];
    if ((a == i) == (b == i)) continue;
    lost += conductances.value[t];
    strained += conductances.value[t] * 0.05 * (1 + (a == j || b == j));
  }
  EXPECT_NEAR(pfv::mean_pore_strain(s.network, conductances, pressures, none, changes, volumes) /
                  (strained / lost), 1.0, 1e-12);
}

}  // namespace
}  // namespace strain_measure_test
