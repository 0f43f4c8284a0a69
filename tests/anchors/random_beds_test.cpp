// SPDX-License-Identifier: GPL-3.0-or-later
// 36 equal spheres at random, not touching, beside finite-element Stokes solutions (error 1-1.5 %,
// on the low side). The hydraulic-radius law is too permeable where spheres do not touch (as for
// loosened lattices); how much is recorded here. Forces hardly depend on the law.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace random_beds_test {
namespace {

using namespace support;

struct Comparison {
  double permeability_ratio, median_force_error, largest_force_error;
};

Comparison compare(const std::string& bed, const std::string& wall) {
  const pfv::PackingArrays packing = data_packing("packing_36_" + bed + ".csv");
  pfv::Flow flow(
      upward_box(wall == "symmetry" ? pfv::Wall::symmetry : pfv::Wall::no_slip),
      viscosity_one(), hydraulic_radius());
  const pfv::Forces& forces = flow.evaluate(packing.view());
  Comparison result{};
  for (const Row& row : table("stokes_36_permeability.csv"))
    if (row.at("packing") == "packing_36_" + bed + ".csv" && row.at("wall") == wall)
      result.permeability_ratio = *flow.report().permeability / number(row, "permeability");
  std::vector<double> errors;
  for (const Row& row : table("stokes_36_" + bed + "_forces.csv")) {
    const Eigen::Vector3d exact(number(row, wall + "_fx"), number(row, wall + "_fy"),
                                number(row, wall + "_fz"));
    const auto k = static_cast<Eigen::Index>(number(row, "id")) - 1;
    errors.push_back((forces.total.col(k) - exact).norm() / exact.norm());
  }
  std::sort(errors.begin(), errors.end());
  result.median_force_error = errors[errors.size() / 2];
  result.largest_force_error = errors.back();
  return result;
}

void expect_recorded(const Comparison& measured, const Comparison& recorded) {
  EXPECT_NEAR(measured.permeability_ratio, recorded.permeability_ratio, 1e-4);
  EXPECT_NEAR(measured.median_force_error, recorded.median_force_error, 1e-3);
  EXPECT_NEAR(measured.largest_force_error, recorded.largest_force_error, 1e-3);
}

TEST(RandomBeds, PermeabilityAndForcesAreRecordedBesideTheStokesSolution) {
  expect_recorded(compare("near_touching", "no_slip"), {1.2642, 0.113, 0.300});
  expect_recorded(compare("near_touching", "symmetry"), {1.6397, 0.120, 0.293});
  expect_recorded(compare("loose", "no_slip"), {1.9882, 0.115, 0.322});
  expect_recorded(compare("loose", "symmetry"), {2.7497, 0.141, 0.276});
}

double permeability(const std::string& bed, pfv::Wall wall, pfv::ConductanceLaw law) {
  pfv::Options options;
  options.conductance = law;
  pfv::Flow flow(upward_box(wall), viscosity_one(), options);
  flow.evaluate(data_packing(bed + ".csv").view());
  return *flow.report().permeability;
}

// The paper's ratios over its packings of 8 to 200 spheres: hydraulic radius 1.01 on average with
// symmetry walls, 0.78 with no-slip walls, effective radius 0.39. Ours keep gaps of 2 %, through
// which the hydraulic radius lets too much; nine_spheres_test.cpp has 8 and 9.
TEST(RandomBeds, Of25And54SpheresAreRecordedForThePapersLaws) {
  struct Recorded {
    std::string bed;
    pfv::Wall wall;
    double hydraulic, effective;
  };
  const std::vector<Recorded> all{{"bed_25", pfv::Wall::symmetry, 2.1180, 0.2002},
                                  {"bed_25", pfv::Wall::no_slip, 1.0624, 0.4761},
                                  {"bed_54", pfv::Wall::symmetry, 1.5285, 0.2468},
                                  {"bed_54", pfv::Wall::no_slip, 1.2107, 0.4510}};
  for (const Recorded& recorded : all) {
    const std::string wall = recorded.wall == pfv::Wall::symmetry ? "symmetry" : "no_slip";
    double exact = 0.0;
    for (const Row& row : table("stokes_beds_permeability.csv"))
      if (row.at("bed") == recorded.bed && row.at("wall") == wall)
        exact = number(row, "permeability");
    const auto ratio = [&](pfv::ConductanceLaw law) {
      return permeability(recorded.bed, recorded.wall, law) / exact;
    };
    EXPECT_NEAR(ratio(pfv::ConductanceLaw::hydraulic_radius), recorded.hydraulic, 1e-4);
    EXPECT_NEAR(ratio(pfv::ConductanceLaw::effective_radius), recorded.effective, 1e-4);
  }
}

// No finite elements of 200 spheres exist here: the laws beside each other.
TEST(RandomBeds, Of200SpheresTheLawsStandApartAsInSmallerOnes) {
  const auto over_open = [](pfv::Wall wall, pfv::ConductanceLaw law) {
    return permeability("bed_200", wall, law) /
           permeability("bed_200", wall, pfv::ConductanceLaw::open_throat);
  };
  using Law = pfv::ConductanceLaw;
  EXPECT_NEAR(over_open(pfv::Wall::symmetry, Law::hydraulic_radius), 1.3655, 1e-4);
  EXPECT_NEAR(over_open(pfv::Wall::no_slip, Law::hydraulic_radius), 1.1231, 1e-4);
  EXPECT_NEAR(over_open(pfv::Wall::symmetry, Law::effective_radius), 0.2798, 1e-4);
  EXPECT_NEAR(over_open(pfv::Wall::no_slip, Law::effective_radius), 0.4797, 1e-4);
}

}  // namespace
}  // namespace random_beds_test
