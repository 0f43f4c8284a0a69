// SPDX-License-Identifier: GPL-3.0-or-later
// Packing and box -> pores and throats: dual vertices, topology, sum rules.
#include "network/facets.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace network_test {
namespace {

using namespace support;

std::vector<Stages> random_networks() {
  std::vector<Stages> all;
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  all.push_back(stages_of(random_packing(300, 0.02, 0.06, 1), box));
  all.push_back(stages_of(random_packing(150, 0.01, 0.12, 2), box));
  all.push_back(stages_of(data_packing("packing_100.csv"), box));
  all.push_back(stages_of(data_packing("packing_500.csv"), box));
  return all;
}

// Power |P - x|² - r², equal for all spheres of the cell; signed sums would not notice a wrong P.
TEST(DualVertices, HaveEqualPowerToTheirSpheresAndLieOnTheirWalls) {
  for (const Stages& s : random_networks())
    for (int c = 0; c < s.network.cells(); ++c) {
      const auto& cell = s.network.cell_vertices[c];
      const Eigen::Vector3d p = s.network.cell_centres.col(c);
      const auto power = [&](int k) {
        const double r = s.spheres.radii[k];
        return (p - s.spheres.centres.col(k)).squaredNorm() - r * r;
      };
      for (const pfv::Vertex v : cell) {
        if (pfv::is_wall(v)) {
          const int face = pfv::wall_number(v);
          EXPECT_EQ(p[face / 2], face % 2 ? 1.0 : 0.0);
        } else {
          // relative to the square of the distance, in which round-off arises
          const double scale = (p - s.spheres.centres.col(v)).squaredNorm() + 0.01;
          EXPECT_NEAR(power(v), power(cell[0]), 1e-12 * scale);
        }
      }
      EXPECT_TRUE((p.array() >= 0.0).all() && (p.array() <= 1.0).all());
    }
}

TEST(DualEdges, AreNormalToTheirFacetsAndPointAlongTheirNormals) {
  for (const Stages& s : random_networks()) {
    const double spacing = std::cbrt(1.0 / s.spheres.size());
    for (int f = 0; f < s.network.facets(); ++f) {
      const auto& cells = s.network.facet_cells[f];
      const Eigen::Vector3d edge =
          s.network.cell_centres.col(cells[1]) - s.network.cell_centres.col(cells[0]);
      const Eigen::Vector3d normal = pfv::unit_normal(s.network.facet_vertices[f], s.spheres);
      EXPECT_GT(edge.dot(normal), -1e-12 * spacing);
      EXPECT_LT((edge - edge.dot(normal) * normal).norm(), 1e-12 * spacing);
    }
  }
}

TEST(Topology, EachFacetStandsOnceAndItsCellsKnowEachOther) {
  for (const Stages& s : random_networks()) {
    const auto& network = s.network;
    std::set<std::pair<int, int>> pairs;
    for (int f = 0; f < network.facets(); ++f) {
      const auto [a, b] = network.facet_cells[f];
      EXPECT_TRUE(pairs.insert(std::minmax(a, b)).second);
      for (const auto& [cell, other] : {std::pair{a, b}, std::pair{b, a}}) {
        int shared = -1;
        for (int i = 0; i < 4; ++i)
          if (network.cell_neighbours[cell][i] == other) shared = i;
        ASSERT_GE(shared, 0);
        auto opposite = pfv::facet_opposite(network.cell_vertices[cell], shared);
        auto facet = network.facet_vertices[f];
        EXPECT_TRUE(std::is_permutation(facet.begin(), facet.end(), opposite.begin()));
      }
    }
    std::size_t sides = 0;  // each open side of a cell is one side of one facet
    for (const auto& neighbours : network.cell_neighbours)
      for (const int n : neighbours) sides += n >= 0;
    EXPECT_EQ(sides, 2 * pairs.size());
  }
}

TEST(Topology, ACellHasNoNeighbourOnlyBeyondTheWallsOfACorner) {
  for (const Stages& s : random_networks())
    for (int c = 0; c < s.network.cells(); ++c)
      for (int i = 0; i < 4; ++i) {
        const bool corner = i == 0 && pfv::is_wall(s.network.cell_vertices[c][1]);
        EXPECT_EQ(s.network.cell_neighbours[c][i] < 0, corner);
      }
}

TEST(Topology, ThroatsJoinDifferentPoresAndStandOnce) {
  for (const auto& packing : {lattice(Lattice::sc, 4), lattice(Lattice::bcc, 3),
                              lattice(Lattice::fcc, 3), data_packing("packing_500.csv")}) {
    const Stages s = stages_of(packing, pfv::Box{});
    std::set<std::pair<int, int>> pairs;
    for (int t = 0; t < s.network.throats(); ++t) {
      const auto [i, j] = s.network.throat_pores[t];
      EXPECT_LT(i, j);
      EXPECT_TRUE(pairs.insert({i, j}).second);
      EXPECT_LT(s.network.throat_facets[t], s.network.throat_facets[t + 1]);
      EXPECT_GT(s.throats.length[t], 0.0);
      const Eigen::Vector3d way =
          s.network.pore_centres.col(j) - s.network.pore_centres.col(i);
      EXPECT_GT(way.dot(s.throats.normal.col(t)), 0.0);
    }
    for (int f = s.network.throat_facets.back(); f < s.network.facets(); ++f)
      EXPECT_EQ(s.network.cell_pore[s.network.facet_cells[f][0]],
                s.network.cell_pore[s.network.facet_cells[f][1]]);
  }
}

TEST(SumRules, PoreVolumeIsTheBoxLessTheSpheres) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto packing = random_packing(200, seed < 3 ? 0.03 : 0.005, 0.1, seed);
    const Stages s = stages_of(packing, upward_box(pfv::Wall::no_slip));
    const double exact = 1.0 - solid_volume(packing);
    double pores = 0.0, throats = 0.0;
    for (const double v : s.throats.pore_fluid_volume) pores += v;
    for (const double v : s.throats.volume) throats += v;
    EXPECT_EQ(s.network.throat_facets.back(), s.network.facets());  // nothing is merged here
    EXPECT_NEAR(pores / exact, 1.0, 1e-12);
    EXPECT_NEAR(throats / exact, 1.0, 1e-12);
  }
}

TEST(SumRules, SurfaceIsThatOfTheSpheresAndNoSlipWalls) {
  for (const pfv::Wall wall : {pfv::Wall::no_slip, pfv::Wall::symmetry}) {
    const auto packing = random_packing(200, 0.02, 0.1, 5);
    const Stages sealed = stages_of(packing, [&] {
      pfv::Box box;
      for (const pfv::Face face : pfv::all_faces) box[face].wall = wall;
      return box;
    }());
    const double walls = wall == pfv::Wall::no_slip ? 6.0 : 0.0;
    double pores = 0.0, throats = 0.0;
    for (const double v : sealed.throats.pore_gamma) pores += v;
    for (const double v : sealed.throats.gamma) throats += v;
    EXPECT_NEAR(pores / (solid_surface(packing) + walls), 1.0, 1e-12);
    EXPECT_NEAR(throats / (solid_surface(packing) + walls), 1.0, 1e-12);
  }
}

// A face with a pressure is fluid: only the four others rub, all over.
TEST(SumRules, OpenFacesDoNotRub) {
  const auto packing = random_packing(200, 0.02, 0.1, 5);
  const Stages s = stages_of(packing, upward_box(pfv::Wall::no_slip));
  double gamma = 0.0;
  for (const double v : s.throats.gamma) gamma += v;
  EXPECT_NEAR(gamma / (solid_surface(packing) + 4.0), 1.0, 1e-12);
}

TEST(SumRules, HoldForFullSpheresOfLatticesToo) {
  for (const Lattice kind : {Lattice::sc, Lattice::bcc, Lattice::fcc}) {
    const auto packing = lattice(kind, 4, 0.5);  // shrunk: none crosses a face
    const Stages s = stages_of(packing, pfv::Box{});
    double volume = 0.0, gamma = 0.0;
    for (const double v : s.throats.pore_fluid_volume) volume += v;
    for (const double v : s.throats.pore_gamma) gamma += v;
    EXPECT_NEAR(volume / (1.0 - solid_volume(packing)), 1.0, 1e-12);
    EXPECT_NEAR(gamma / (solid_surface(packing) + 6.0), 1.0, 1e-12);
  }
}

TEST(Locate, FindsTheCellThatContainsAPlace) {
  const Stages s = stages_of(data_packing("packing_500.csv"), pfv::Box{});
  Random random(3);
  int cell = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d place = random.in_cube(0.0, 1.0);
    cell = pfv::locate(s.network, s.spheres, place, cell);
    for (int k = 0; k < 4; ++k) {
      if (s.network.cell_neighbours[cell][k] < 0) continue;
      const auto facet = pfv::facet_opposite(s.network.cell_vertices[cell], k);
      EXPECT_LE((place - s.spheres.centres.col(facet[0]))
                    .dot(pfv::unit_normal(facet, s.spheres)),
                1e-12);
    }
  }
}

TEST(HiddenSpheres, AreNoVertices) {
  const Stages s = stages_of(
      packing_of({{0.5, 0.5, 0.5, 0.3}, {0.55, 0.5, 0.5, 0.1}, {0.1, 0.1, 0.1, 0.05}}),
      pfv::Box{});
  EXPECT_EQ(s.network.hidden, std::vector<int>{1});
  for (const auto& cell : s.network.cell_vertices)
    for (const int v : cell) EXPECT_NE(v, 1);
}

}  // namespace
}  // namespace network_test
