// SPDX-License-Identifier: GPL-3.0-or-later
// The default law and its estimated error beside Stokes flow in packings with finite-element
// solutions (stokes_beds_*.csv: one mesh, K low by 1 to 3 %) and in periodic random beds beside the
// correlation of van der Hoef, Beetstra & Kuipers (2005). doc/accuracy.md tells how each was made.
// No number of the law was fitted on them; those of bed_24 were looked at while its form was
// chosen.
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace beds_test {
namespace {

using namespace support;
using pfv::ConductanceLaw;

struct Solution {
  double permeability, estimate;  ///< m², and |ln| that is expected at most
  Eigen::Matrix3Xd forces;
};

Solution solve(const pfv::PackingArrays& packing, const pfv::Box& box, ConductanceLaw law) {
  pfv::Options options;
  options.conductance = law;
  pfv::Flow flow(box, viscosity_one(), options);
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  const pfv::Report report = flow.report();
  const double permeability =
      report.permeability_tensor ? report.permeability_tensor->trace() / 3.0 : *report.permeability;
  EXPECT_TRUE(report.outside_range.empty());
  return {permeability, std::log1p(*report.permeability_error), forces};
}

pfv::Box box_with(const std::string& wall) {
  return upward_box(wall == "symmetry" ? pfv::Wall::symmetry : pfv::Wall::no_slip);
}

pfv::Box cell() {
  pfv::Box box;
  box.periodic = {true, true, true};
  return box;
}

/// Of equal spheres in a random bed, m².
double correlation(const pfv::PackingArrays& packing) {
  const double c = solid_volume(packing), d = 2.0 * packing.radii[0];
  const double drag =
      10.0 * c / std::pow(1.0 - c, 2) + std::pow(1.0 - c, 2) * (1.0 + 1.5 * std::sqrt(c));
  return d * d * (1.0 - c) / (18.0 * c * drag);
}

struct Recorded {
  std::string bed, wall;
  double ratio, median, worst;  ///< K over Stokes flow; errors of the forces on spheres
};

/// Median (upper) and largest error of the forces, of their exact size; 0 where none are known.
std::array<double, 2> force_errors(const std::string& bed, const std::string& wall,
                                   const Eigen::Matrix3Xd& forces) {
  std::vector<double> errors;
  for (const Row& row : table("stokes_beds_forces.csv")) {
    if (row.at("bed") != bed || row.at("wall") != wall) continue;
    const Eigen::Vector3d exact(number(row, "fx"), number(row, "fy"), number(row, "fz"));
    const auto k = static_cast<Eigen::Index>(number(row, "id")) - 1;
    errors.push_back((forces.col(k) - exact).norm() / exact.norm());
  }
  if (errors.empty()) return {0.0, 0.0};
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

// Goals: K within 10 %: measured within 9.2 %. Forces within 8 % (median) and 25 % (worst): missed
// by far shrunk spheres (x 0.7), by sizes 3 to 8 and 4 (the small spheres), by single spheres
// elsewhere.
TEST(Beds, OpenThroatIsRecordedBesideFiniteElements) {
  const std::vector<Recorded> all{{"bed_24_x1", "no_slip", 0.9898, 0.053, 0.156},
                                  {"bed_24_x1", "symmetry", 1.0604, 0.063, 0.108},
                                  {"bed_24_x0.95", "no_slip", 0.9848, 0.054, 0.151},
                                  {"bed_24_x0.95", "symmetry", 1.0392, 0.057, 0.109},
                                  {"bed_24_x0.7", "no_slip", 0.9330, 0.144, 0.233},
                                  {"bed_24_x0.7", "symmetry", 1.0310, 0.124, 0.195},
                                  {"bed_24_x1.03", "no_slip", 0.9853, 0.0, 0.0},
                                  {"bed_24_x1.03", "symmetry", 1.0817, 0.0, 0.0},
                                  {"bed_24_half", "no_slip", 0.9959, 0.075, 0.167},
                                  {"bed_24_half", "symmetry", 1.0502, 0.069, 0.205},
                                  {"bed_24_small", "symmetry", 1.0914, 0.131, 0.427},
                                  {"bed_25", "no_slip", 0.9459, 0.055, 0.283},
                                  {"bed_25", "symmetry", 0.9956, 0.047, 0.167},
                                  {"bed_54", "no_slip", 1.0239, 0.058, 0.299},
                                  {"bed_54", "symmetry", 1.0188, 0.053, 0.149},
                                  {"bed_two_sizes", "symmetry", 0.9685, 0.141, 0.489},
                                  {"bed_cavity", "symmetry", 0.9996, 0.062, 0.215},
                                  {"packing_100", "symmetry", 1.0129, 0.0, 0.0}};
  const std::vector<Row> rows = table("stokes_beds_permeability.csv");
  ASSERT_EQ(rows.size(), all.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Recorded& recorded = all[i];
    SCOPED_TRACE(recorded.bed + ", " + recorded.wall);
    ASSERT_EQ(rows[i].at("bed"), recorded.bed);
    ASSERT_EQ(rows[i].at("wall"), recorded.wall);
    const Solution found = solve(data_packing(recorded.bed + ".csv"), box_with(recorded.wall),
                                 ConductanceLaw::open_throat);
    const double ratio = found.permeability / number(rows[i], "permeability");
    EXPECT_NEAR(ratio, recorded.ratio, 1e-4);
    EXPECT_NEAR(ratio, 1.0, 0.092);
    const auto [median, worst] = force_errors(recorded.bed, recorded.wall, found.forces);
    EXPECT_NEAR(median, recorded.median, 1e-3);
    EXPECT_NEAR(worst, recorded.worst, 1e-3);
  }
}

// Goal: within 12 % from solid fraction 0.3 to 0.64. Measured within 6.8 %; the papers' law is 1.15
// to 2.60 times too permeable.
TEST(Beds, OpenThroatIsWithin7PerCentOfTheCorrelationInPeriodicRandomBeds) {
  const std::vector<std::pair<std::string, double>> all{
      {"30", 0.9701}, {"40", 0.9760}, {"50", 0.9927}, {"55", 0.9910},
      {"60", 1.0121}, {"63", 1.0684}, {"64", 1.0543}};
  for (const auto& [percent, recorded] : all) {
    const pfv::PackingArrays packing = data_packing("bed_periodic_" + percent + ".csv");
    EXPECT_NEAR(solid_volume(packing), 0.01 * std::stod(percent), 2e-3);
    const double ratio =
        solve(packing, cell(), ConductanceLaw::open_throat).permeability / correlation(packing);
    EXPECT_NEAR(ratio, recorded, 1e-4) << percent;
    EXPECT_NEAR(ratio, 1.0, 0.07) << percent;
  }
}

struct Errors {
  double actual, estimate;
};

template <class Visit>
void for_each_bed(Visit&& visit) {
  for (const Row& row : table("stokes_beds_permeability.csv"))
    visit(data_packing(row.at("bed") + ".csv"), box_with(row.at("wall")),
          number(row, "permeability"));
  for (const Row& row : table("stokes_36_permeability.csv"))
    visit(data_packing(row.at("packing")), box_with(row.at("wall")), number(row, "permeability"));
  for (const Row& row : table("stokes_nine_spheres.csv"))
    visit(nine_spheres(number(row, "d_over_D")), box_with(row.at("wall")),
          number(row, "permeability"));
  for (const char* percent : {"30", "40", "50", "55", "60", "63", "64"}) {
    const pfv::PackingArrays packing =
        data_packing("bed_periodic_" + std::string(percent) + ".csv");
    visit(packing, cell(), correlation(packing));
  }
}

Errors errors(const pfv::PackingArrays& packing, const pfv::Box& box, double exact,
              ConductanceLaw law) {
  const Solution found = solve(packing, box, law);
  return {std::abs(std::log(found.permeability / exact)), found.estimate};
}

// What makes it the default.
TEST(Beds, OpenThroatIsNowhereWorseThanTheHydraulicRadiusByMoreThan2PerCent) {
  for_each_bed([](const pfv::PackingArrays& packing, const pfv::Box& box, double exact) {
    EXPECT_LE(errors(packing, box, exact, ConductanceLaw::open_throat).actual,
              errors(packing, box, exact, ConductanceLaw::hydraulic_radius).actual + 0.02);
  });
}

struct Coverage {
  ConductanceLaw law;
  int covered;
  double too_large;  ///< mean estimate over mean error
};

// Goal: the estimate covers 80 % of the anchors and is not more than 3 times too large on average.
// Measured here without the lattices, which doc/accuracy.md adds.
TEST(Beds, TheEstimatedErrorCoversTheActualOne) {
  for (const Coverage& recorded : {Coverage{ConductanceLaw::open_throat, 40, 2.97},
                                   Coverage{ConductanceLaw::effective_radius, 37, 1.07},
                                   Coverage{ConductanceLaw::hydraulic_radius, 39, 1.30}}) {
    int covered = 0, all = 0;
    double actual = 0.0, estimate = 0.0;
    for_each_bed([&](const pfv::PackingArrays& packing, const pfv::Box& box, double exact) {
      const Errors one = errors(packing, box, exact, recorded.law);
      covered += one.actual <= one.estimate;
      ++all;
      actual += one.actual;
      estimate += one.estimate;
    });
    EXPECT_EQ(all, 41);
    EXPECT_EQ(covered, recorded.covered) << pfv::name_of(recorded.law);
    EXPECT_GE(covered, 0.8 * all) << pfv::name_of(recorded.law);
    EXPECT_NEAR(estimate / actual, recorded.too_large, 0.01) << pfv::name_of(recorded.law);
  }
}

}  // namespace
}  // namespace beds_test
