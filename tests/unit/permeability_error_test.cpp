// SPDX-License-Identifier: GPL-3.0-or-later
// The error that is told with a permeability: its terms, when there is one, and when it warns.
#include "pfv/pfv.hpp"
#include "physics/permeability_error.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace permeability_error_test {
namespace {

using namespace support;
using pfv::ConductanceLaw;

pfv::Report report_of(const pfv::PackingArrays& packing, const pfv::Box& box,
                      ConductanceLaw law = ConductanceLaw::open_throat) {
  pfv::Options options;
  options.conductance = law;
  pfv::Flow flow(box, viscosity_one(), options);
  flow.evaluate(packing.view());
  return flow.report();
}

pfv::PackingArrays scaled(pfv::PackingArrays packing, double scale) {
  packing.radii *= scale;
  return packing;
}

// Spheres that touch between symmetry walls: nothing but the law's own 0.055.
TEST(PermeabilityError, IsTheBaseErrorWhereSpheresTouch) {
  const pfv::Report report = report_of(nine_spheres(0.0), upward_box(pfv::Wall::symmetry));
  EXPECT_NEAR(*report.permeability_error, std::expm1(0.055), 1e-9);
  EXPECT_EQ(*report.degenerate_share, 0.0);
  EXPECT_TRUE(report.outside_range.empty());
}

// Every throat of the loosened array that carries flow is the same, so that the sum over throats is
// exact: |ln K_law / K_open_throat| and 5 % more, beside the open-throat law's own error.
TEST(PermeabilityError, AddsTheDifferenceOfAnotherLaw) {
  const pfv::PackingArrays packing = scaled(nine_spheres(0.0), 0.9);
  const pfv::Box box = upward_box(pfv::Wall::symmetry);
  const pfv::Report open = report_of(packing, box);
  const pfv::Report other = report_of(packing, box, ConductanceLaw::hydraulic_radius);
  const double bias = std::abs(std::log(*other.permeability / *open.permeability));
  EXPECT_GT(bias, 0.5);
  EXPECT_NEAR(std::log1p(*other.permeability_error),
              std::log1p(*open.permeability_error) + 1.05 * bias, 1e-9);
}

// A cell repeated twice has the same throats twice as often: the part that averages falls by half in the square.
TEST(PermeabilityError, AveragesOverThroatsThatErrOnTheirOwn) {
  std::vector<double> squares;
  for (const int copies : {1, 2, 4}) {
    const pfv::PackingArrays one = scaled(data_packing("bed_periodic_40.csv"), 0.8);
    const Eigen::Index count = one.radii.size();
    pfv::PackingArrays packing;
    packing.ids = pfv::Packing::Ids::LinSpaced(copies * count, 1, copies * count);
    packing.positions.resize(3, copies * count);
    packing.radii = one.radii.replicate(copies, 1);
    for (int copy = 0; copy < copies; ++copy)
      packing.positions.middleCols(copy * count, count) = one.positions.colwise() + copy * Eigen::Vector3d::UnitX();
    pfv::Box box;
    box.upper = {static_cast<double>(copies), 1.0, 1.0};
    box.periodic = {true, true, true};
    box.pressure_gradient = {0.0, 0.0, -1.0};
    squares.push_back(std::pow(std::log1p(*report_of(packing, box).permeability_error), 2));
  }
  EXPECT_GT(squares[0], 1.01 * squares[1]);
  EXPECT_NEAR((squares[0] - squares[1]) / (squares[1] - squares[2]), 2.0, 1e-6);
}

TEST(PermeabilityError, DoesNotDependOnViscosityOrPressure) {
  const pfv::PackingArrays packing = random_packing(20, 0.05, 0.15, 5);
  pfv::Fluid thick = viscosity_one();
  thick.viscosity = 7.0;
  pfv::Flow a(upward_box(pfv::Wall::no_slip), viscosity_one(), hydraulic_radius());
  pfv::Flow b(pressure_box(pfv::Face::zlo, 300.0, pfv::Face::zhi, 100.0, pfv::Wall::no_slip),
              thick, hydraulic_radius());
  a.evaluate(packing.view());
  b.evaluate(packing.view());
  EXPECT_NEAR(*a.report().permeability_error, *b.report().permeability_error, 1e-12);
}

TEST(PermeabilityError, ExistsWithAPermeabilityOnly) {
  const pfv::PackingArrays packing = lattice(Lattice::sc, 3);
  pfv::Box cell;
  cell.periodic = {true, true, true};
  const pfv::Report tensor = report_of(packing, cell);  // no gradient: of the tensor
  EXPECT_FALSE(tensor.permeability);
  EXPECT_NEAR(*tensor.permeability_error, std::expm1(0.055), 1e-9);

  pfv::Box sideways = upward_box(pfv::Wall::no_slip);
  sideways[pfv::Face::xlo].boundary = pfv::Boundary::pressure(0.5);
  const pfv::Report none = report_of(packing, sideways);
  EXPECT_FALSE(none.permeability || none.permeability_error || none.degenerate_share);
  EXPECT_TRUE(none.outside_range.empty());
}

void expect_one_reason(const pfv::Report& report, const std::string& part) {
  ASSERT_EQ(report.outside_range.size(), 1u);
  EXPECT_NE(report.outside_range[0].find(part), std::string::npos) << report.outside_range[0];
}

TEST(PermeabilityError, WarnsOutsideWhatItWasComparedWith) {
  const pfv::Box slip = upward_box(pfv::Wall::symmetry);
  expect_one_reason(report_of(scaled(nine_spheres(0.0), 1.1), slip), "overlaps hide");
  expect_one_reason(report_of(scaled(nine_spheres(0.0), 0.05), slip), "solid fraction");
  expect_one_reason(report_of(packing_of({{0.5, 0.5, 0.5, 0.1}}), upward_box(pfv::Wall::no_slip)),
                    "no-slip walls");
  std::vector<Sphere> spheres{{0.25, 0.25, 0.5, 0.2}, {0.75, 0.75, 0.5, 0.2}};
  for (int k = 0; k < 40; ++k)
    spheres.push_back({0.05 + 0.022 * k, 0.95 - 0.022 * k, 0.3 + 0.01 * k, 0.01});
  expect_one_reason(report_of(packing_of(spheres), slip), "size ratio above 10");
}

// Throats whose domain has no positive volume or surface take the rule's 0.5 and are counted.
TEST(PermeabilityError, CountsTheDissipationOfDegenerateThroats) {
  Stages s = stages_of(nine_spheres(0.0), upward_box(pfv::Wall::symmetry));
  const auto conductances = pfv::conductances(ConductanceLaw::open_throat, 1.0, s.network,
                                              s.throats, s.spheres);
  std::vector<double> dissipation(s.network.throats(), 0.0);
  dissipation[0] = 3.0;
  dissipation[1] = 1.0;
  s.throats.volume[1] = -s.throats.volume[1];
  const pfv::PermeabilityError error =
      pfv::permeability_error(s.network, s.throats, s.spheres, ConductanceLaw::open_throat, 1.0,
                              conductances, dissipation, 0.5);
  EXPECT_NEAR(error.degenerate_share.value(), 0.25, 1e-12);
  EXPECT_NEAR(std::log1p(error.relative.value()), 0.75 * 0.055 + 0.25 * 0.5, 1e-9);
  ASSERT_EQ(error.outside_range.size(), 1u);
  EXPECT_NE(error.outside_range[0].find("degenerate throats"), std::string::npos);
}

TEST(PermeabilityError, IsUnknownWhereGrainsDoNotFitBetweenTheFaces) {
  pfv::Box box = pressure_box(pfv::Face::xlo, 1.0, pfv::Face::xhi, 0.0, pfv::Wall::symmetry);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) spheres.push_back({0.125 + 0.25 * i, 0.125 + 0.25 * j, 0.01, j == 0 ? 0.009 : 0.1});
  box.upper[2] = 0.02;
  pfv::Flow flow(box, viscosity_one());
  const pfv::PackingArrays packing = packing_of(spheres);
  flow.evaluate(packing.view());
  const pfv::Report report = flow.report();
  ASSERT_FALSE(report.outside_range.empty());
  EXPECT_NE(report.outside_range.back().find("two opposite faces make up, of all grains, 75 %"), std::string::npos)
      << report.outside_range.back();
  EXPECT_FALSE(report.permeability_error) << *report.permeability_error << ' ' << *report.permeability;
}

TEST(PermeabilityError, IsAbsentWhereNothingFlows) {
  std::vector<Sphere> spheres;  // a layer that closes the box
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) spheres.push_back({0.125 + 0.25 * i, 0.125 + 0.25 * j, 0.5, 0.2});
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one());
  const pfv::PackingArrays packing = packing_of(spheres);
  flow.evaluate(packing.view());
  EXPECT_EQ(flow.report().permeability.value(), 0.0);
  EXPECT_FALSE(flow.report().permeability_error);
}

}  // namespace
}  // namespace permeability_error_test
