// SPDX-License-Identifier: GPL-3.0-or-later
// The default law and its estimated error beside Stokes flow in packings with finite-element
// solutions (stokes_beds_*.csv: one mesh, K low by 1 to 3 %) and in periodic random beds beside the
// correlation of van der Hoef, Beetstra & Kuipers (2005). doc/accuracy.md tells how each was made. No
// number of the law was fitted on them; those of bed_24 were looked at while its form was chosen.
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

// Goals: K within 10 %, forces within 8 % (median) and 25 % (worst). Missed: by far shrunk spheres
// (x 0.7, forces), by sizes 3 to 8 and 4 (forces on the small spheres), by single spheres elsewhere.
TEST(Beds, OpenThroatIsRecordedBesideFiniteElements) {
  const std::vector<Recorded> all{{"bed_24_x1", "no_slip", 1.0140, 0.053, 0.157},
                                  {"bed_24_x1", "symmetry", 1.0937, 0.061, 0.098},
                                  {"bed_24_x0.95", "no_slip", 1.0088, 0.052, 0.147},
                                  {"bed_24_x0.95", "symmetry", 1.0689, 0.060, 0.110},
                                  {"bed_24_x0.7", "no_slip", 0.8999, 0.145, 0.233},
                                  {"bed_24_x0.7", "symmetry", 0.9882, 0.125, 0.195},
                                  {"bed_24_x1.03", "no_slip", 0.9790, 0.0, 0.0},
                                  {"bed_24_x1.03", "symmetry", 1.0749, 0.0, 0.0},
                                  {"bed_24_half", "no_slip", 1.0174, 0.094, 0.211},
                                  {"bed_24_half", "symmetry", 1.0806, 0.076, 0.272},
                                  {"bed_24_small", "symmetry", 1.1029, 0.132, 0.499},
                                  {"bed_25", "no_slip", 0.9636, 0.060, 0.280},
                                  {"bed_25", "symmetry", 1.0115, 0.043, 0.168},
                                  {"bed_54", "no_slip", 1.0586, 0.060, 0.307},
                                  {"bed_54", "symmetry", 1.0591, 0.048, 0.147},
                                  {"bed_two_sizes", "symmetry", 0.9734, 0.143, 0.469},
                                  {"bed_cavity", "symmetry", 1.0353, 0.058, 0.203},
                                  {"packing_100", "symmetry", 0.9998, 0.0, 0.0}};
  const std::vector<Row> rows = table("stokes_beds_permeability.csv");
  ASSERT_EQ(rows.size(), all.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Recorded& recorded = all[i];
    SCOPED_TRACE(recorded.bed + ", " + recorded.wall);
    ASSERT_EQ(rows[i].at("bed"), recorded.bed);
    ASSERT_EQ(rows[i].at("wall"), recorded.wall);
    const Solution found = solve(data_packing(recorded.bed + ".csv"), box_with(recorded.wall),
                                 ConductanceLaw::open_throat);
    EXPECT_NEAR(found.permeability / number(rows[i], "permeability"), recorded.ratio, 1e-4);
    const auto [median, worst] = force_errors(recorded.bed, recorded.wall, found.forces);
    EXPECT_NEAR(median, recorded.median, 1e-3);
    EXPECT_NEAR(worst, recorded.worst, 1e-3);
  }
}

// Goal: within 12 % from solid fraction 0.3 to 0.64. Measured within 7.8 %; the papers' law is 1.19 to
// 2.60 times too permeable.
TEST(Beds, OpenThroatIsWithin8PerCentOfTheCorrelationInPeriodicRandomBeds) {
  const std::vector<std::pair<std::string, double>> all{{"30", 0.9534}, {"40", 0.9801},
                                                        {"50", 1.0178}, {"55", 1.0251},
                                                        {"60", 1.0486}, {"63", 1.0771}};
  for (const auto& [percent, recorded] : all) {
    const pfv::PackingArrays packing = data_packing("bed_periodic_" + percent + ".csv");
    EXPECT_NEAR(solid_volume(packing), 0.01 * std::stod(percent), 2e-3);
    const double ratio =
        solve(packing, cell(), ConductanceLaw::open_throat).permeability / correlation(packing);
    EXPECT_NEAR(ratio, recorded, 1e-4) << percent;
    EXPECT_NEAR(ratio, 1.0, 0.08) << percent;
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
  for (const char* percent : {"30", "40", "50", "55", "60", "63"}) {
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

// Goal: the estimate covers 80 % of the anchors and is not more than 3 times too large on average.
// Measured without the lattices: 35 of 40 and 2.0 times (open throat), 35 and 1.2 (hydraulic radius).
TEST(Beds, TheEstimatedErrorCoversTheActualOne) {
  for (const ConductanceLaw law : {ConductanceLaw::open_throat, ConductanceLaw::hydraulic_radius}) {
    int covered = 0, all = 0;
    double actual = 0.0, estimate = 0.0;
    for_each_bed([&](const pfv::PackingArrays& packing, const pfv::Box& box, double exact) {
      const Errors one = errors(packing, box, exact, law);
      covered += one.actual <= one.estimate;
      ++all;
      actual += one.actual;
      estimate += one.estimate;
    });
    EXPECT_EQ(all, 40);
    EXPECT_GE(covered, 35) << pfv::name_of(law);
    EXPECT_LT(estimate / actual, 2.1) << pfv::name_of(law);
  }
}

}  // namespace
