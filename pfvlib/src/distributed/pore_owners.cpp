// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/pore_owners.hpp"

#include "pfv/error.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace pfv {

namespace {

/// The vertices of a pore's first cell, by which all ranks know it.
using Name = std::array<std::int64_t, 4>;

Name name_of(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  Name name;
  for (int i = 0; i < 4; ++i)
    name[i] = is_wall(cell[i]) ? std::numeric_limits<std::int64_t>::min() + wall_number(cell[i]) : spheres.ids[cell[i]];
  std::sort(name.begin(), name.end());
  return name;
}

std::vector<int> first_cell_of_pores(const PoreNetwork& network) {
  std::vector<int> first(network.pores(), -1);
  for (int c = network.cells() - 1; c >= 0; --c) first[network.cell_pore[c]] = c;
  return first;
}

std::string text_of(const Name& name) {
  std::string text;
  for (const std::int64_t id : name)
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

void find_owners(const PoreNetwork& network, const ActiveGrains& grains, const Halo& halo,
                 const std::vector<char>& whole_cells, Share& share) {
  const Ranks& ranks = *share.ranks;
  const int count = ranks.count();
  share.spheres = exchange_of_spheres(grains, halo);
  share.own_pores.assign(network.pores(), 0);
  share.whole_pores.assign(network.pores(), 0);
  share.pores.sent.resize(count);
  share.pores.received.resize(count);
  std::vector<std::pair<Name, int>> own;
  std::vector<Ranks::Bytes> to(count);
  const std::vector<int> first = first_cell_of_pores(network);
  for (int pore = 0; pore < network.pores(); ++pore) {
    share.whole_pores[pore] = whole_cells[first[pore]];
    if (!share.whole_pores[pore]) continue;
    const auto& cell = network.cell_vertices[first[pore]];
    const int owner = halo.owner_of(grains.columns[cell[0]]);
    const Name name = name_of(cell, grains.spheres);
    if (owner == ranks.own()) {
      share.own_pores[pore] = 1;
      own.push_back({name, pore});
    } else {
      append(to[owner], &name, 1);
      share.pores.received[owner].push_back(pore);
    }
  }
  std::sort(own.begin(), own.end());
  const std::vector<Ranks::Bytes> from = ranks.hand_over(to);
  ranks.together([&] {
    for (int r = 0; r < count; ++r) {
      if (r == ranks.own()) continue;
      for (const Name& name : values_in<Name>(from[r])) {
        const auto found = std::lower_bound(own.begin(), own.end(), std::pair(name, -1));
        if (found == own.end() || found->first != name)
          throw SolverError("the ranks have found different pores between spheres " + text_of(name) +
                            ": please report this; a run on one rank avoids it");
        share.pores.sent[r].push_back(found->second);
      }
    }
  });
}

}  // namespace pfv
