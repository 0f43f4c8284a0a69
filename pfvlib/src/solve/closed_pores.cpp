// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/closed_pores.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>

namespace pfv {

namespace {

constexpr int none = -1, several = -2;
constexpr double weak = 0.1;  // as a part of the median conductance

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

/// Throats between spheres of one body only are its surface; two of its spheres make a throat one of its creases.
enum class AtBody { no, crease, surface };

AtBody throat_at_body(const PoreNetwork& network, int throat, const std::vector<int>& body) {
  AtBody result = AtBody::surface;
  for (int facet = network.throat_facets[throat]; facet < network.throat_facets[throat + 1]; ++facet) {
    std::array<int, 3> own{};
    for (int k = 0; k < 3; ++k) {
      const Vertex vertex = network.facet_vertices[facet][k];
      own[k] = is_wall(vertex) ? none : body[network.vertex_sphere[vertex]];
    }
    if (own[0] >= 0 && own[0] == own[1] && own[1] == own[2]) continue;
    const bool two = (own[0] >= 0 && (own[0] == own[1] || own[0] == own[2])) || (own[1] >= 0 && own[1] == own[2]);
    if (!two) return AtBody::no;
    result = AtBody::crease;
  }
  return result;
}

/// Conductances without those that next to nothing flows through, of throats in the creases of a body.
std::vector<double> without_weak(const PoreNetwork& network, const std::vector<double>& conductances,
                                 const std::vector<int>& body) {
  std::vector<double> open;
  for (const double one : conductances)
    if (one > 0.0) open.push_back(one);
  if (open.empty()) return conductances;
  const auto middle = open.begin() + static_cast<std::ptrdiff_t>(open.size() / 2);
  std::nth_element(open.begin(), middle, open.end());
  std::vector<double> strong = conductances;
  for (int t = 0; t < network.throats(); ++t)
    if (strong[t] < weak * *middle && throat_at_body(network, t, body) != AtBody::no) strong[t] = 0.0;
  return strong;
}

/// Joins each of the sets (by pore; -1 for others) to the fluid by the widest way out of it: through throats in the
/// order of conductance, then of area, never through the surface of a body.
void join_to_the_fluid(const PoreNetwork& network, const Throats& throats, const std::vector<double>& conductances,
                       const std::vector<int>& set_of_pore, const std::vector<int>& body, const Unknowns& unknowns,
                       DisjointSets& sets) {
  const auto unknown = [&](int throat, int side) { return unknowns.of_pore[network.throat_pores[throat][side]]; };
  std::vector<char> cut_off(unknowns.count, 0);
  std::vector<int> ways;
  for (int t = 0; t < network.throats(); ++t) {
    const auto& pores = network.throat_pores[t];
    if ((set_of_pore[pores[0]] < 0 && set_of_pore[pores[1]] < 0) || unknown(t, 0) < 0 || unknown(t, 1) < 0) continue;
    for (int side = 0; side < 2; ++side)
      if (set_of_pore[pores[side]] >= 0) cut_off[unknown(t, side)] = 1;
    if (throat_at_body(network, t, body) != AtBody::surface) ways.push_back(t);
  }
  std::stable_sort(ways.begin(), ways.end(), [&](int a, int b) {
    return conductances[a] != conductances[b] ? conductances[a] > conductances[b] : throats.area[a] > throats.area[b];
  });
  std::vector<char> reaches_fluid(unknowns.count, 0);
  for (int u = 0; u < unknowns.count; ++u) reaches_fluid[u] = !cut_off[u];
  for (const int t : ways) {
    const int a = sets.find(unknown(t, 0)), b = sets.find(unknown(t, 1));
    const bool fluid = reaches_fluid[a] || reaches_fluid[b];
    if (a == b || (reaches_fluid[a] && reaches_fluid[b])) continue;
    sets.join(a, b);
    reaches_fluid[sets.find(a)] = fluid;
  }
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

/// What is no fluid has no way out.
void close_throats_of(const std::vector<int>& enclosed, const PoreNetwork& network, std::vector<double>& conductances) {
  std::vector<char> closed(network.pores(), 0);
  for (const int pore : enclosed) closed[pore] = 1;
  for (int t = 0; t < network.throats(); ++t)
    if (closed[network.throat_pores[t][0]] || closed[network.throat_pores[t][1]]) conductances[t] = 0.0;
}

}  // namespace

ClosedPores take_out_closed_pores(const PoreNetwork& network, const Throats& throats, const std::vector<int>& body,
                                  std::vector<double>& conductances, Unknowns& unknowns) {
  ClosedPores closed;
  std::vector<Isolated> isolated = find_isolated(network, without_weak(network, conductances, body), unknowns);
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
    for (const int pore : isolated[i].pores) {
      if (around.body[i] >= 0) {
        unknowns.of_pore[pore] = Unknowns::imposed;
        unknowns.enclosed_pores.push_back(pore);
      } else if (around.at_body[i]) {
        ++closed.joined;
        continue;
      }
      set_of_pore[pore] = none;
    }
  }
  closed.enclosed = static_cast<int>(unknowns.enclosed_pores.size());
  close_throats_of(unknowns.enclosed_pores, network, conductances);
  DisjointSets sets(unknowns.count);
  for (const Isolated& one : isolated)
    for (const int pore : one.pores)
      if (set_of_pore[pore] >= 0) sets.join(unknowns.of_pore[one.pores[0]], unknowns.of_pore[pore]);
  join_to_the_fluid(network, throats, conductances, set_of_pore, body, unknowns, sets);
  renumber(unknowns, sets);
  return closed;
}

}  // namespace pfv
