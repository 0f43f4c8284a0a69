// SPDX-License-Identifier: GPL-3.0-or-later
// The network that several ranks make together is that of one rank, value for value.
#include "world.hpp"

#include "pfv/dense_packing.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"
#include "support/adversarial.hpp"
#include "support/containers.hpp"
#include "support/random_beds.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace {

using Name = std::array<std::int64_t, 4>;

std::vector<Name> names_of_pores(const pfv::BuiltNetwork& built) {
  std::vector<Name> names(built.network.pores());
  for (int c = built.network.cells() - 1; c >= 0; --c) {
    Name& name = names[built.network.cell_pore[c]];
    for (int i = 0; i < 4; ++i) {
      const pfv::Vertex v = built.network.cell_vertices[c][i];
      name[i] = pfv::is_wall(v) ? std::numeric_limits<std::int64_t>::min() + pfv::wall_number(v) : built.vertices.ids[v];
    }
    std::sort(name.begin(), name.end());
  }
  return names;
}

/// What is known of a pore, by names.
struct PoreValues {
  double volume = 0.0, fluid_volume = 0.0;
  Eigen::Vector3d centre;
  pfv::FaceSet faces = 0;
  Eigen::Vector3d bases = Eigen::Vector3d::Zero();
  std::map<Name, double> conductances;
  std::map<std::int64_t, Eigen::Matrix<double, 6, 1>> pulls;  ///< entries of S, by sphere

  bool operator==(const PoreValues& other) const {
    return volume == other.volume && fluid_volume == other.fluid_volume && centre == other.centre &&
           faces == other.faces && bases == other.bases && conductances == other.conductances && pulls == other.pulls;
  }
};

std::map<Name, PoreValues> pores_of(const pfv::BuiltNetwork& built) {
  const std::vector<Name> names = names_of_pores(built);
  std::vector<PoreValues> values(names.size());
  for (std::size_t p = 0; p < names.size(); ++p) {
    values[p].volume = built.throats.pore_volume[p];
    values[p].fluid_volume = built.throats.pore_fluid_volume[p];
    values[p].centre = built.network.pore_centres.col(static_cast<Eigen::Index>(p));
    values[p].faces = built.network.pore_faces[p];
  }
  for (int b = 0; b < built.bases.size(); ++b) values[built.bases.pore[b]].bases += built.bases.load(b).head<3>();
  for (int t = 0; t < built.network.throats(); ++t) {
    const auto [i, j] = built.network.throat_pores[t];
    values[i].conductances[names[j]] = values[j].conductances[names[i]] = built.conductances.value[t];
  }
  const pfv::ForceMatrix& s = *built.operators.force_matrix;
  for (int row = 0; row < s.spheres; ++row)
    for (int i = s.row_begin[row]; i < s.row_begin[row + 1]; ++i)
      values[s.pore[i]].pulls[built.vertices.ids[row]] = s.value.col(i);
  std::map<Name, PoreValues> result;
  for (std::size_t p = 0; p < names.size(); ++p)
    if (built.share.owns_pore(static_cast<int>(p))) result[names[p]] = values[p];
  return result;
}

struct Built {
  std::unique_ptr<pfv::BuiltNetwork> network;
  std::string refusal;
};

Built built_of(const pfv::Packing& packing, const pfv::Container& container, std::shared_ptr<const pfv::Ranks> ranks) {
  const pfv::Fluid fluid;
  pfv::Options options;
  options.solver = pfv::SolverKind::amg;
  options.torques = true;
  const auto team = std::make_shared<pfv::Team>();
  const pfv::Problem problem{container, fluid, options, team, ranks};
  pfv::WorkRecord work;
  Built built;
  try {
    built.network = pfv::derive_network(packing, problem, work);
    pfv::make_force_matrix(*built.network, problem, work.counts);
  } catch (const pfv::Error& error) {
    built.refusal = error.what();
  }
  return built;
}

/// Compares what this rank has with the network of one rank.
void expect_same(const pfv::PackingArrays& packing, const pfv::Container& container, Deal deal) {
  const Built whole = built_of(packing.view(), container, nullptr);
  const pfv::PackingArrays part = part_of(packing, own_columns(packing, deal));
  const Built shared = built_of(part.view(), container, world());
  ASSERT_EQ(shared.refusal.empty(), whole.refusal.empty()) << shared.refusal << " / " << whole.refusal;
  if (!whole.refusal.empty()) return;
  const auto expected = pores_of(*whole.network), found = pores_of(*shared.network);
  int unknown = 0, different = 0;
  for (const auto& [name, values] : found) {
    const auto place = expected.find(name);
    if (place == expected.end()) ++unknown;
    else if (!(values == place->second)) ++different;
  }
  EXPECT_EQ(unknown, 0);
  EXPECT_EQ(different, 0);
  for (const auto& [i, j] : shared.network->network.throat_pores)
    if (shared.network->share.own_pores[i] || shared.network->share.own_pores[j]) {
      ASSERT_TRUE(shared.network->share.whole_pores[i] && shared.network->share.whole_pores[j]);
    }
  EXPECT_EQ(world()->sum(static_cast<double>(found.size())), static_cast<double>(expected.size()));
  EXPECT_EQ(pfv::hidden_spheres(*shared.network), pfv::hidden_spheres(*whole.network));
  EXPECT_EQ(pfv::merged_pores(*shared.network), pfv::merged_pores(*whole.network));
  EXPECT_EQ(pfv::degenerate_throats(*shared.network), pfv::degenerate_throats(*whole.network));
}

pfv::PackingArrays numbered(pfv::PackingArrays packing) {
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) packing.ids[k] = 7 * (k % 13) * 1000003 + k + 1;
  return packing;
}

}  // namespace

TEST(SharedNetwork, IsThatOfOneRankForADenseBed) {
  const pfv::PackingArrays bed = numbered(pfv::dense_packing(700));
  for (const Deal deal : {Deal::by_place, Deal::at_random, Deal::all_to_one}) expect_same(bed, pfv::Box{}, deal);
}

TEST(SharedNetwork, IsThatOfOneRankForUnlikeSpheresAndVoids) {
  expect_same(numbered(support::random_packing(500, 0.015, 0.075, 2)), pfv::Box{}, Deal::by_place);
  expect_same(numbered(support::without_the_middle(pfv::dense_packing(1500), 0.35)), pfv::Box{}, Deal::by_place);
}

TEST(SharedNetwork, IsThatOfOneRankForALatticeWhosePoresMerge) {
  for (const auto kind : {support::Lattice::sc, support::Lattice::fcc})
    expect_same(support::lattice(kind, 5), pfv::Box{}, Deal::by_place);
}

/// The hole that a grain leaves in such a lattice is one pore of twelve grains, whose own neighbours are far.
TEST(SharedNetwork, IsThatOfOneRankForPoresOfManyGrains) {
  const pfv::PackingArrays lattice = support::lattice(support::Lattice::fcc, 4, 0.93);
  for (const int gone : {37, 101, 150}) {
    std::vector<int> kept;
    for (int k = 0; k < static_cast<int>(lattice.ids.size()); ++k)
      if (k != gone) kept.push_back(k);
    for (const Deal deal : {Deal::by_place, Deal::at_random}) expect_same(numbered(part_of(lattice, kept)), pfv::Box{}, deal);
  }
}

TEST(SharedNetwork, IsThatOfOneRankForAFewGrainsInMuchWater) {
  expect_same(numbered(support::random_packing(30, 0.02, 0.04, 3)), pfv::Box{}, Deal::by_place);
  expect_same(numbered(support::random_packing(5, 0.02, 0.04, 3)), pfv::Box{}, Deal::at_random);
  expect_same(numbered(support::random_packing(1, 0.02, 0.04, 3)), pfv::Box{}, Deal::by_place);
}

TEST(SharedNetwork, IsThatOfOneRankInContainers) {
  support::Random random(5);
  const pfv::Container wedge = support::wedge(), prism = support::prism(7, 0.4, 1.0);
  const pfv::Container cylinder = support::cylinder({0.0, 0.0, 1.0}, {0.5, 0.5, 0.0}, 0.4, 1.0);
  for (const pfv::Container& container : {wedge, prism, cylinder})
    expect_same(numbered(support::spheres_in(container, 300, 0.06, random)), container, Deal::by_place);
}

/// PFV_RANK_PACKINGS: how many.
TEST(SharedNetwork, IsThatOfOneRankForWhatIsHardToTriangulate) {
  const char* wanted = std::getenv("PFV_RANK_PACKINGS");
  const int count = wanted ? std::atoi(wanted) : 200;
  support::Random random(11);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("packing " + std::to_string(i));
    const auto kind = static_cast<std::size_t>(i) % (support::adversarial::kinds.size() + 1);
    const bool plain = kind == support::adversarial::kinds.size();
    const pfv::PackingArrays packing =
        numbered(plain ? support::random_packing(support::whole(random, 20, 150), 0.02, random(0.03, 0.09),
                                                 static_cast<std::uint64_t>(i))
                       : support::packing_of(support::adversarial::spheres_of(kind, random)));
    expect_same(packing, pfv::Box{}, i % 2 ? Deal::at_random : Deal::by_place);
    if (HasFailure()) return;
  }
}
