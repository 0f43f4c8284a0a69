// SPDX-License-Identifier: GPL-3.0-or-later
// YADE 2023.02a, the reference implementation of the method, on packing_100 and packing_500. Its
// rules differ from ours (support/yade_rules.hpp). With its rules on our network its numbers come
// out, so network, system and solver agree with it and the rules are the whole difference.
#include "support/motions.hpp"
#include "support/yade_rules.hpp"

#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <ostream>

namespace yade_test {
namespace {

using namespace support;

struct Case {
  std::string spheres, wall;
  pfv::Wall type() const {
    return wall == "symmetry" ? pfv::Wall::symmetry : pfv::Wall::no_slip;
  }
  std::string file(const std::string& end) const { return "yade_" + spheres + "_" + wall + end; }
  pfv::PackingArrays packing() const { return data_packing("packing_" + spheres + ".csv"); }
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.spheres << " spheres, " << c.wall;
}

pfv::Box downward_box(pfv::Wall wall) {
  return pressure_box(pfv::Face::zhi, 1.0, pfv::Face::zlo, 0.0, wall);
}

/// Our cell for each of YADE's, by their vertices.
std::vector<int> cells_of(const std::vector<Row>& theirs, const Stages& s) {
  std::map<std::array<int, 4>, int> ours;
  for (int c = 0; c < s.network.cells(); ++c) {
    std::array<int, 4> key = s.network.cell_vertices[c];
    for (int& v : key)
      if (!pfv::is_wall(v)) v = static_cast<int>(s.spheres.ids[v]);
    std::sort(key.begin(), key.end());
    ours[key] = c;
  }
  std::vector<int> cells;
  for (const Row& row : theirs) {
    std::array<int, 4> key;
    for (int i = 0; i < 4; ++i) key[i] = std::stoi(row.at("v" + std::to_string(i)));
    std::sort(key.begin(), key.end());
    const auto found = ours.find(key);
    cells.push_back(found == ours.end() ? -1 : found->second);
  }
  return cells;
}

int walls_of(const Stages& s, int cell) {
  int walls = 0;
  for (const int v : s.network.cell_vertices[cell]) walls += pfv::is_wall(v);
  return walls;
}

Eigen::Matrix3Xd force_table(const std::string& name, int spheres) {
  Eigen::Matrix3Xd forces(3, spheres);
  for (const Row& row : table(name))
    forces.col(static_cast<int>(number(row, "id")) - 1) << number(row, "fx"), number(row, "fy"),
        number(row, "fz");
  return forces;
}

/// Spheres of which no cell touches a wall.
std::vector<int> interior_spheres(const Stages& s) {
  std::vector<char> interior(s.spheres.size(), 1);
  for (int c = 0; c < s.network.cells(); ++c)
    if (walls_of(s, c) > 0)
      for (const int v : s.network.cell_vertices[c])
        if (!pfv::is_wall(v)) interior[v] = 0;
  std::vector<int> result;
  for (int k = 0; k < s.spheres.size(); ++k)
    if (interior[k]) result.push_back(k);
  return result;
}

class YadeCells : public testing::TestWithParam<Case> {};

TEST_P(YadeCells, HasOurCellsAndCentres) {
  const Stages s = stages_of(GetParam().packing(), downward_box(GetParam().type()));
  const auto rows = table(GetParam().file("_flow_cells.csv"));
  const auto cells = cells_of(rows, s);
  ASSERT_EQ(static_cast<int>(rows.size()), s.network.cells());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    ASSERT_GE(cells[c], 0) << "no cell with the vertices of YADE's cell " << c;
    const Eigen::Vector3d centre(number(rows[c], "px"), number(rows[c], "py"),
                                 number(rows[c], "pz"));
    // its walls are spheres of 50000 box lengths: centres on them are off by up to 4.6e-5
    const double bound = walls_of(s, cells[c]) == 0 ? 2e-15 : 5e-5;
    EXPECT_LT((centre - s.network.cell_centres.col(cells[c])).norm(), bound);
  }
}

TEST_P(YadeCells, ItsRulesGiveItsInteriorConductances) {
  const Stages s = stages_of(GetParam().packing(), downward_box(GetParam().type()));
  const auto rows = table(GetParam().file("_flow_cells.csv"));
  const auto cells = cells_of(rows, s);
  std::map<std::pair<int, int>, int> facet_between;
  for (int f = 0; f < s.network.facets(); ++f)
    facet_between[std::minmax(s.network.facet_cells[f][0], s.network.facet_cells[f][1])] = f;
  double worst = 0.0;
  int compared = 0;
  for (std::size_t c = 0; c < rows.size(); ++c)
    for (int i = 0; i < 4; ++i) {
      const int neighbour = std::stoi(rows[c].at("n" + std::to_string(i)));
      if (neighbour < 0 || walls_of(s, cells[c]) + walls_of(s, cells[neighbour]) > 0) continue;
      const int a = cells[c], b = cells[neighbour];
      const double theirs = number(rows[c], "k" + std::to_string(i));
      const double ours = yade_throat(s, facet_between.at(std::minmax(a, b))).conductance;
      worst = std::max(worst, std::abs(ours / theirs - 1.0));
      ++compared;
    }
  EXPECT_EQ(compared, GetParam().spheres == "100" ? 1132 : 8050);
  EXPECT_LT(worst, 3e-12);  // measured 1.3e-13 (100 spheres) and 1.4e-12 (500)
}

TEST_P(YadeCells, ItsPressuresGiveItsForces) {
  const Stages s = stages_of(GetParam().packing(), downward_box(GetParam().type()));
  const auto rows = table(GetParam().file("_flow_cells.csv"));
  const auto cells = cells_of(rows, s);
  Eigen::VectorXd pressures(s.network.pores());
  for (std::size_t c = 0; c < rows.size(); ++c)
    pressures[s.network.cell_pore[cells[c]]] = number(rows[c], "p");
  const Eigen::Matrix3Xd difference = yade_forces(s, pressures) -
      force_table(GetParam().file("_flow_forces.csv"), s.spheres.size());
  for (const int k : interior_spheres(s))
    EXPECT_LT(difference.col(k).norm(), 2e-17) << "sphere " << s.spheres.ids[k];
  // at walls its centres' round-off shows (measured 1.7e-7); the spheres in the corners are among
  // these: their error of up to 5e-2 is the corner cells that its loop leaves out
  EXPECT_LT(difference.colwise().norm().maxCoeff(), 2e-7);
}

INSTANTIATE_TEST_SUITE_P(Packings, YadeCells,
                         testing::Values(Case{"100", "symmetry"}, Case{"100", "no_slip"},
                                         Case{"500", "symmetry"}));

class YadeFlow : public testing::TestWithParam<Case> {};

TEST_P(YadeFlow, ItsRulesGiveItsPermeabilityAndForces) {
  const Stages s = stages_of(GetParam().packing(), downward_box(GetParam().type()));
  const auto conductances = yade_conductances(s);
  const Eigen::VectorXd p =
      pressures_of(s, conductances, Eigen::VectorXd::Zero(s.network.pores()));
  const double theirs = json(GetParam().file("_flow.json"))["permeability"];
  // measured -9.0e-6, -3.2e-6, -2.0e-5, -7.7e-6: its centres on the walls are off by 1e-5
  EXPECT_NEAR(rate_from(s, pfv::Face::zhi, conductances, p) / theirs, 1.0, 2.1e-5);
  const Eigen::Matrix3Xd difference =
      yade_forces(s, p) - force_table(GetParam().file("_flow_forces.csv"), s.spheres.size());
  EXPECT_LT(difference.colwise().norm().maxCoeff(), 2e-7);  // measured 1.7e-7, of 4e-2
}

INSTANTIATE_TEST_SUITE_P(Packings, YadeFlow,
                         testing::Values(Case{"100", "symmetry"}, Case{"100", "no_slip"},
                                         Case{"500", "symmetry"}, Case{"500", "no_slip"}));

class YadeMoving : public testing::TestWithParam<Case> {};

TEST_P(YadeMoving, ItsRulesGiveItsForcesUnderADrainedPiston) {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].wall = GetParam().type();
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  box[pfv::Face::zhi].velocity = -1.0;
  const Stages s = stages_of(GetParam().packing(), box);
  Eigen::Matrix3Xd velocities = Eigen::Matrix3Xd::Zero(3, s.spheres.size());
  velocities.row(2) = -s.spheres.centres.row(2);
  const Eigen::VectorXd rates = geometric_rates(s, velocities, box);
  const Eigen::VectorXd p = pressures_of(s, yade_conductances(s), rates);
  const Eigen::Matrix3Xd theirs =
      force_table(GetParam().file("_moving_forces.csv"), s.spheres.size());
  const Eigen::VectorXd error =
      (yade_forces(s, p) - theirs).colwise().norm() / theirs.colwise().norm().maxCoeff();
  // measured 1.9e-5 and 1.8e-5: the round-off of its centres on the walls, as in still grains
  EXPECT_LT(error.maxCoeff(), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Packings, YadeMoving,
                         testing::Values(Case{"500", "symmetry"}, Case{"500", "no_slip"}));

/// Flow rate with the unit cube's pressures: the permeability.
double permeability(const Stages& s, const std::vector<double>& conductances) {
  const Eigen::VectorXd p =
      pressures_of(s, conductances, Eigen::VectorXd::Zero(s.network.pores()));
  return rate_from(s, pfv::Face::zhi, conductances, p);
}

/// Our permeability over YADE's, and what of it each rule is worth.
struct Shares {
  double total, lenses, partition, symmetry_factor;
};

void expect_shares(const Case& c, const Shares& expected) {
  const Stages s = stages_of(c.packing(), downward_box(c.type()));
  const auto own = pfv::conductances(pfv::ConductanceLaw::hydraulic_radius, 1.0, s.network,
                                     s.throats, s.spheres);
  const double ours = permeability(s, own.value);
  const double full_sectors = permeability(s, yade_conductances(s, {false, false}));
  const double no_factor = permeability(s, yade_conductances(s, {true, false}));
  const double theirs = permeability(s, yade_conductances(s));
  EXPECT_NEAR(ours / theirs, expected.total, 1e-4);
  EXPECT_NEAR(ours / full_sectors, expected.lenses, 1e-4);
  EXPECT_NEAR(full_sectors / no_factor, expected.partition, 1e-4);
  EXPECT_NEAR(no_factor / theirs, expected.symmetry_factor, 1e-4);
}

// Values of our own, recorded to show how the differences come about: overlapping discs counted
// once, the signed partition, and no factor 2^(-n_w/2) at symmetry walls (facts of the three rules
// above).
TEST(YadeDifferences, EachRuleIsWorthItsShareOfThePermeability) {
  expect_shares({"100", "symmetry"}, {1.2488, 1.0555, 1.0052, 1.1770});
  expect_shares({"100", "no_slip"}, {1.0449, 1.0346, 1.0100, 1.0});
  expect_shares({"500", "symmetry"}, {1.2784, 1.0608, 1.0027, 1.2019});
  expect_shares({"500", "no_slip"}, {1.0512, 1.0460, 1.0050, 1.0});
}

}  // namespace
}  // namespace yade_test
