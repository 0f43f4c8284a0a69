// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/closed_pores.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>

namespace pfv {

namespace {

constexpr int none = -1, several = -2;

/// What stands around each set of pores.
struct Surroundings {
  std::vector<int> body;      ///< the one body all around it, or `none`, or `several`
  std::vector<char> at_body;  ///< whether any sphere around it belongs to one
};

Surroundings surroundings_of(const PoreNetwork& network, const std::vector<int>& set_of_pore, std::size_t sets,
                             const std::vector<int>& body) {
  std::vector<char> seen(sets, 0);
  Surroundings around{std::vector<int>(sets, none), std::vector<char>(sets, 0)};
  for (int c = 0; c < network.cells(); ++c) {
    const int set = set_of_pore[network.cell_pore[c]];
    if (set < 0) continue;
    for (const Vertex vertex : network.cell_vertices[c]) {
      const int own = is_wall(vertex) ? none : body[network.vertex_sphere[vertex]];
      if (own >= 0) around.at_body[set] = 1;
      if (!seen[set]) around.body[set] = own;
      if (around.body[set] != own) around.body[set] = several;
      seen[set] = 1;
    }
  }
  return around;
}

/// Of each set the pore with an unknown behind the widest throat that leads out of it, or `none`.
std::vector<int> neighbours_of(const PoreNetwork& network, const Throats& throats,
                               const std::vector<int>& set_of_pore, std::size_t sets, const Unknowns& unknowns) {
  std::vector<int> neighbour(sets, none);
  std::vector<double> widest(sets, 0.0);
  for (int t = 0; t < network.throats(); ++t)
    for (int side = 0; side < 2; ++side) {
      const auto& pores = network.throat_pores[t];
      const int set = set_of_pore[pores[side]], other = pores[1 - side];
      if (set < 0 || set_of_pore[other] == set || unknowns.of_pore[other] < 0 || !(throats.area[t] > widest[set]))
        continue;
      widest[set] = throats.area[t];
      neighbour[set] = other;
    }
  return neighbour;
}

/// Numbers them anew in the order of the pores; `sets`: of the old ones.
void renumber(Unknowns& unknowns, DisjointSets& sets) {
  std::vector<int> fresh(unknowns.count, none);
  unknowns.count = 0;
  const auto number = [&](int old) {
    int& own = fresh[sets.find(old)];
    if (own < 0) own = unknowns.count++;
    return own;
  };
  for (int& unknown : unknowns.of_pore)
    if (unknown >= 0) unknown = number(unknown);
  for (int& unknown : unknowns.of_boundary)
    if (unknown >= 0) unknown = number(unknown);
}

}  // namespace

ClosedPores take_out_closed_pores(const PoreNetwork& network, const Throats& throats,
                                  const std::vector<double>& conductances, const std::vector<int>& body,
                                  Unknowns& unknowns) {
  ClosedPores closed;
  std::vector<Isolated> isolated = find_isolated(network, conductances, unknowns);
  if (isolated.empty()) return closed;
  // where no pressure is imposed the largest set is the fluid itself
  const auto largest = std::max_element(isolated.begin(), isolated.end(), [](const auto& a, const auto& b) {
    return a.pores.size() < b.pores.size();
  });
  if (unknowns.imposed_pores.empty()) isolated.erase(largest);
  std::vector<int> set_of_pore(network.pores(), none);
  for (std::size_t i = 0; i < isolated.size(); ++i)
    for (const int pore : isolated[i].pores) set_of_pore[pore] = static_cast<int>(i);
  const Surroundings around = surroundings_of(network, set_of_pore, isolated.size(), body);
  for (std::size_t i = 0; i < isolated.size(); ++i) {
    if (around.body[i] < 0) continue;
    for (const int pore : isolated[i].pores) {
      unknowns.of_pore[pore] = Unknowns::imposed;
      unknowns.enclosed_pores.push_back(pore);
    }
  }
  closed.enclosed = static_cast<int>(unknowns.enclosed_pores.size());
  const std::vector<int> neighbour = neighbours_of(network, throats, set_of_pore, isolated.size(), unknowns);
  DisjointSets sets(unknowns.count);
  for (std::size_t i = 0; i < isolated.size(); ++i) {
    if (around.body[i] >= 0 || !around.at_body[i] || neighbour[i] < 0) continue;
    for (const int pore : isolated[i].pores) sets.join(unknowns.of_pore[pore], unknowns.of_pore[neighbour[i]]);
    closed.joined += static_cast<int>(isolated[i].pores.size());
  }
  renumber(unknowns, sets);
  return closed;
}

}  // namespace pfv
