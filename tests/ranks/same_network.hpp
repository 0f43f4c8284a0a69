// SPDX-License-Identifier: GPL-3.0-or-later
// Holds the network that several ranks make against that of one rank.
#pragma once

#include "world.hpp"

#include "network/periodic_images.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <string>
#include <utility>

/// Ids of the vertices of a pore's first cell and, where they are images, how many periods each is away.
using Name = std::array<std::array<std::int64_t, 4>, 4>;

inline std::vector<Name> names_of_pores(const pfv::BuiltNetwork& built) {
  std::vector<Name> names(built.network.pores());
  for (int c = built.network.cells() - 1; c >= 0; --c) {
    Name& name = names[built.network.cell_pore[c]];
    for (int i = 0; i < 4; ++i) {
      const pfv::Vertex v = built.network.cell_vertices[c][i];
      name[i] = {pfv::is_wall(v) ? std::numeric_limits<std::int64_t>::min() + pfv::wall_number(v) : built.vertices.ids[v]};
      if (pfv::is_wall(v)) continue;
      const auto shift = pfv::periods_of(built.network, built.grains.spheres, built.vertices, v);
      std::copy(shift.begin(), shift.end(), name[i].begin() + 1);
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
  std::map<std::pair<Name, std::array<double, 3>>, double> conductances;  ///< by the pore beyond, and its image there
  std::map<std::int64_t, Eigen::Matrix<double, 6, 1>> pulls;  ///< entries of S, by sphere

  /// What is not the same, in words; empty: all is.
  std::string unlike(const PoreValues& other) const {
    return std::string(volume == other.volume ? "" : " volume") + (fluid_volume == other.fluid_volume ? "" : " fluid volume") +
           (centre == other.centre ? "" : " centre") + (faces == other.faces ? "" : " faces") +
           (bases == other.bases ? "" : " bases") + (conductances == other.conductances ? "" : " conductances") +
           (pulls == other.pulls ? "" : " pulls");
  }
};

inline std::map<Name, PoreValues> pores_of(const pfv::BuiltNetwork& built) {
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
    const Eigen::Vector3d way = built.network.throat_offset(t);
    values[i].conductances[{names[j], {way[0], way[1], way[2]}}] = built.conductances.value[t];
    values[j].conductances[{names[i], {-way[0], -way[1], -way[2]}}] = built.conductances.value[t];
  }
  const pfv::ForceMatrix& s = *built.operators.force_matrix;
  for (int row = 0; row < s.spheres; ++row)
    for (int i = s.row_begin[row]; i < s.row_begin[row + 1]; ++i)
      values[s.pore[i]].pulls[built.grains.spheres.ids[row]] = s.value.col(i);
  std::map<Name, PoreValues> result;
  for (std::size_t p = 0; p < names.size(); ++p)
    if (built.share.owns_pore(static_cast<int>(p))) result[names[p]] = values[p];
  return result;
}

struct Built {
  std::unique_ptr<pfv::BuiltNetwork> network;
  std::string refusal;
};

inline Built built_of(const pfv::Packing& packing, const pfv::Container& container, std::shared_ptr<const pfv::Ranks> ranks) {
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

/// Compares what this rank has with the network of one rank, whose pores are `expected`.
inline void expect_same(const Built& shared, const Built& whole, const std::map<Name, PoreValues>& expected) {
  ASSERT_EQ(shared.refusal.empty(), whole.refusal.empty()) << shared.refusal << " / " << whole.refusal;
  if (!whole.refusal.empty()) return;
  const auto found = pores_of(*shared.network);
  int unknown = 0;
  std::map<std::string, int> unlike;
  for (const auto& [name, values] : found) {
    const auto place = expected.find(name);
    if (place == expected.end()) ++unknown;
    else if (const std::string what = values.unlike(place->second); !what.empty()) ++unlike[what];
  }
  EXPECT_EQ(unknown, 0);
  for (const auto& [what, count] : unlike) ADD_FAILURE() << count << " pores differ in" << what;
  for (const auto& [i, j] : shared.network->network.throat_pores)
    if (shared.network->share.own_pores[i] || shared.network->share.own_pores[j]) {
      ASSERT_TRUE(shared.network->share.whole_pores[i] && shared.network->share.whole_pores[j]);
    }
  EXPECT_EQ(world()->sum(static_cast<double>(found.size())), static_cast<double>(expected.size()));
  EXPECT_EQ(pfv::hidden_spheres(*shared.network), pfv::hidden_spheres(*whole.network));
  EXPECT_EQ(pfv::merged_pores(*shared.network), pfv::merged_pores(*whole.network));
  EXPECT_EQ(pfv::degenerate_throats(*shared.network), pfv::degenerate_throats(*whole.network));
}

inline void expect_same(const pfv::PackingArrays& packing, const pfv::Container& container, const std::vector<Deal>& deals) {
  const Built whole = built_of(packing.view(), container, nullptr);
  const auto expected = whole.refusal.empty() ? pores_of(*whole.network) : std::map<Name, PoreValues>();
  for (const Deal deal : deals) {
    SCOPED_TRACE("deal " + std::to_string(static_cast<int>(deal)));
    const pfv::PackingArrays part = part_of(packing, own_columns(packing, deal));
    expect_same(built_of(part.view(), container, world()), whole, expected);
  }
}

inline pfv::PackingArrays numbered(pfv::PackingArrays packing) {
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) packing.ids[k] = 7 * (k % 13) * 1000003 + k + 1;
  return packing;
}
