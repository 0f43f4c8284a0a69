// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/pore_owners.hpp"

#include "network/periodic_images.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace pfv {

namespace {

/// The vertices of a pore's first cell, by which all ranks know it: ids, and how many periods each is away from its
/// sphere, two a number.
using PoreName = std::array<std::int64_t, 6>;

std::int64_t number_of(const Lattice::Shift& shift) {
  std::int64_t number = 0;
  for (const int periods : shift) number = number * 1024 + periods;
  return number;
}

PoreName name_of(const std::array<Vertex, 4>& cell, const PoreSpace& space, const Spheres& spheres) {
  const bool images = space.network.throat_offsets.cols() > 0;
  std::array<std::pair<std::int64_t, std::int64_t>, 4> vertices;
  for (int i = 0; i < 4; ++i) {
    if (is_wall(cell[i])) vertices[i] = {std::numeric_limits<std::int64_t>::min() + wall_number(cell[i]), 0};
    else vertices[i] = {space.spheres.ids[cell[i]],
                        images ? number_of(periods_of(space.network, spheres, space.spheres, cell[i])) : 0};
  }
  std::sort(vertices.begin(), vertices.end());
  PoreName name{};
  constexpr std::int64_t shifts = std::int64_t{1} << 31;
  for (int i = 0; i < 4; ++i) {
    name[i] = vertices[i].first;
    name[4 + i / 2] = name[4 + i / 2] * shifts + vertices[i].second;
  }
  return name;
}

std::vector<int> first_cell_of_pores(const PoreNetwork& network) {
  std::vector<int> first(network.pores(), -1);
  for (int c = network.cells() - 1; c >= 0; --c) first[network.cell_pore[c]] = c;
  return first;
}

std::string text_of(const PoreName& name) {
  std::string text;
  for (const std::int64_t id : {name[0], name[1], name[2], name[3]})
    if (id > std::numeric_limits<std::int64_t>::min() + 64) text += (text.empty() ? "" : ", ") + std::to_string(id);
  return text;
}

/// The exchange of the spheres of the network: halo columns -> spheres.
Exchange exchange_of_spheres(const ActiveGrains& grains, const Halo& halo) {
  std::vector<int> sphere(static_cast<std::size_t>(halo.seen().size()), -1);
  for (std::size_t i = 0; i < grains.columns.size(); ++i) sphere[grains.columns[i]] = static_cast<int>(i);
  Exchange exchange = halo.exchange();
  for (auto* lists : {&exchange.sent, &exchange.received})
    for (std::vector<int>& list : *lists)
      for (int& column : list) column = sphere[column];
  return exchange;
}

}  // namespace

namespace {

using NamedPores = std::vector<std::pair<PoreName, int>>;

/// Own pores by name, and of others' pores the names, on their way to their owners.
struct Sorted {
  NamedPores own;
  std::vector<Ranks::Bytes> wanted;
};

Sorted sort_pores(const PoreSpace& space, const ActiveGrains& grains, const Halo& halo, Share& share) {
  const PoreNetwork& network = space.network;
  Sorted sorted{{}, std::vector<Ranks::Bytes>(share.ranks->count())};
  const std::vector<int> first = first_cell_of_pores(network);
  for (int pore = 0; pore < network.pores(); ++pore) {
    if (!share.whole_pores[pore]) continue;
    const auto& cell = network.cell_vertices[first[pore]];
    const int owner = halo.owner_of(grains.columns[network.vertex_sphere[cell[0]]]);
    const PoreName name = name_of(cell, space, grains.spheres);
    if (owner == share.ranks->own()) {
      share.own_pores[pore] = 1;
      sorted.own.push_back({name, pore});
    } else {
      append(sorted.wanted[owner], &name, 1);
      share.pores.received[owner].push_back(pore);
    }
  }
  std::sort(sorted.own.begin(), sorted.own.end());
  return sorted;
}

int pore_of(const PoreName& name, const NamedPores& own) {
  const auto found = std::lower_bound(own.begin(), own.end(), std::pair(name, -1));
  if (found != own.end() && found->first == name) return found->second;
  throw SolverError("the ranks have found different pores between spheres " + text_of(name) +
                    ": please report this; a run on one rank avoids it");
}

}  // namespace

void find_owners(const PoreSpace& space, const ActiveGrains& grains, const Halo& halo, const std::vector<char>& whole,
                 Share& share) {
  const Ranks& ranks = *share.ranks;
  share.spheres = exchange_of_spheres(grains, halo);
  share.own_pores.assign(space.network.pores(), 0);
  share.whole_pores = whole;
  share.pores.sent.resize(ranks.count());
  share.pores.received.resize(ranks.count());
  const Sorted sorted = sort_pores(space, grains, halo, share);
  const std::vector<Ranks::Bytes> from = ranks.hand_over(sorted.wanted);
  ranks.together([&] {
    for (int r = 0; r < ranks.count(); ++r)
      for (const PoreName& name : values_in<PoreName>(from[r])) share.pores.sent[r].push_back(pore_of(name, sorted.own));
  });
}

}  // namespace pfv
