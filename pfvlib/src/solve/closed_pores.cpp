// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/closed_pores.hpp"

#include "network/canonical_order.hpp"
#include "network/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace pfv {

namespace {

constexpr int none = -1;
constexpr double weak = 0.1;  // as a part of the median conductance
constexpr double covered = 0.01;  // fluid's part of a throat's area; three equal grains in touch leave 0.093

/// `body` with the grains that stick in one, their centre within a sphere of it beside them, as part of it: with it they
/// close pores as its spheres do among themselves.
std::vector<int> with_stuck_grains(const PoreNetwork& network, const Spheres& vertices, const std::vector<int>& body,
                                   const Share& share) {
  Eigen::VectorXd holder(static_cast<Eigen::Index>(body.size()));
  std::copy(body.begin(), body.end(), holder.begin());
  for (const auto& around : network.cell_vertices)
    for (const Vertex grain : around)
      for (const Vertex other : around) {
        if (is_wall(grain) || is_wall(other) || body[network.vertex_sphere[grain]] >= 0) continue;
        const int held_by = body[network.vertex_sphere[other]];
        const double away = (vertices.centres.col(grain) - vertices.centres.col(other)).squaredNorm();
        double& found = holder[network.vertex_sphere[grain]];
        if (held_by >= 0 && away < vertices.radii[other] * vertices.radii[other]) found = std::max<double>(found, held_by);
      }
  if (share.ranks) share.spheres.refresh(*share.ranks, holder);
  std::vector<int> held(body.size());
  std::transform(holder.begin(), holder.end(), held.begin(), [](double number) { return static_cast<int>(number); });
  return held;
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

/// Value number `place` of the values of all ranks, from 0 on, ascending; all are > 0. Their bits ascend with them.
double value_at(std::vector<double> values, double place, const Share& share) {
  std::sort(values.begin(), values.end());
  const auto value_of = [](std::uint64_t bits) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  };
  std::uint64_t low = 0, high = 0x7ff0000000000000u;  // of infinity
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto below = std::upper_bound(values.begin(), values.end(), value_of(middle)) - values.begin();
    if (share.sum(static_cast<double>(below)) > place) high = middle;
    else low = middle + 1;
  }
  return value_of(low);
}

/// Conductances without those that next to nothing flows through: of throats in the creases of a body, and of any that
/// overlaps have all but covered.
std::vector<double> without_weak(const PoreNetwork& network, const Throats& throats, const std::vector<double>& conductances,
                                 const std::vector<int>& body, const Share& share) {
  std::vector<double> open;
  for (int t = 0; t < network.throats(); ++t)
    if (conductances[t] > 0.0 && share.owns_pore(network.throat_pores[t][0])) open.push_back(conductances[t]);
  const double count = share.sum(static_cast<double>(open.size()));
  if (count == 0.0) return conductances;
  const double median = value_at(std::move(open), std::floor(0.5 * count), share);
  std::vector<double> strong = conductances;
  for (int t = 0; t < network.throats(); ++t)
    if (throats.fluid_area[t] < covered * throats.area[t] ||
        (strong[t] < weak * median && throat_at_body(network, t, body) != AtBody::no))
      strong[t] = 0.0;
  return strong;
}

/// Sets of pores that are cut off, alike on all ranks.
struct CutOff {
  std::vector<Isolated> sets;  ///< with the own pores of each
  std::vector<int> of_pore;    ///< the set of each pore, ghosts included, or `none`
};

/// Where no pressure is imposed the largest set is the fluid itself.
void leave_out_the_fluid(std::vector<Isolated>& sets, const Unknowns& unknowns, const Share& share) {
  if (share.any(!unknowns.imposed_pores.empty())) return;
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(sets.size()));
  for (std::size_t i = 0; i < sets.size(); ++i) sizes[static_cast<Eigen::Index>(i)] = static_cast<double>(sets[i].pores.size());
  share.add(sizes);
  Eigen::Index largest;
  sizes.maxCoeff(&largest);
  sets.erase(sets.begin() + largest);
}

CutOff cut_off_pores(const PoreNetwork& network, const Throats& throats, const std::vector<double>& conductances,
                     const std::vector<int>& body, const Unknowns& unknowns, const Share& share, const RowShare* rows) {
  const std::vector<double> strong = without_weak(network, throats, conductances, body, share);
  CutOff cut{rows ? find_isolated(network, strong, unknowns, share, *rows) : find_isolated(network, strong, unknowns), {}};
  if (!cut.sets.empty()) leave_out_the_fluid(cut.sets, unknowns, share);
  Eigen::VectorXd set = Eigen::VectorXd::Constant(network.pores(), none);
  for (std::size_t i = 0; i < cut.sets.size(); ++i)
    for (const int pore : cut.sets[i].pores) set[pore] = static_cast<double>(i);
  if (share.ranks) share.pores.refresh(*share.ranks, set);
  for (const double own : set) cut.of_pore.push_back(static_cast<int>(own));
  return cut;
}

/// What stands around each set of pores.
struct Surroundings {
  std::vector<char> within;   ///< one body all around it
  std::vector<char> at_body;  ///< whether any sphere around it belongs to one
};

Surroundings surroundings_of(const PoreNetwork& network, const CutOff& cut, const std::vector<int>& body,
                             const Share& share) {
  const auto sets = static_cast<Eigen::Index>(cut.sets.size());
  // of each set the largest number of a body, and that of -number; walls and free spheres are none
  Eigen::VectorXd most = Eigen::VectorXd::Constant(2 * sets, -std::numeric_limits<double>::infinity());
  for (int c = 0; c < network.cells(); ++c) {
    const int set = cut.of_pore[network.cell_pore[c]];
    if (set < 0 || !share.owns_pore(network.cell_pore[c])) continue;
    for (const Vertex vertex : network.cell_vertices[c]) {
      const double own = is_wall(vertex) ? none : body[network.vertex_sphere[vertex]];
      most[set] = std::max(most[set], own);
      most[sets + set] = std::max(most[sets + set], -own);
    }
  }
  if (share.ranks) share.ranks->take_largest(most.data(), static_cast<std::size_t>(most.size()));
  Surroundings around;
  for (Eigen::Index set = 0; set < sets; ++set) {
    around.at_body.push_back(most[set] >= 0.0);
    around.within.push_back(most[set] >= 0.0 && most[set] == -most[sets + set]);
  }
  return around;
}

/// Takes the pores within bodies out of unknowns and sets, and out of the sets those that are at no body.
void take_out_enclosed(const PoreNetwork& network, const Surroundings& around, CutOff& cut, Unknowns& unknowns) {
  for (int pore = 0; pore < network.pores(); ++pore) {
    int& set = cut.of_pore[pore];
    if (set < 0) continue;
    if (around.within[set]) {
      unknowns.of_pore[pore] = Unknowns::imposed;
      unknowns.enclosed_pores.push_back(pore);
    }
    if (around.within[set] || !around.at_body[set]) set = none;
  }
}

/// A throat by a facet of it: its spheres' places along the curve and ids. Decides between ways that are alike.
using ThroatName = std::array<std::pair<std::uint64_t, std::int64_t>, 3>;

ThroatName name_of(const PoreNetwork& network, int throat, const Spheres& vertices,
                   const std::vector<std::uint64_t>& places) {
  ThroatName least;
  for (int facet = network.throat_facets[throat]; facet < network.throat_facets[throat + 1]; ++facet) {
    ThroatName name;
    for (int k = 0; k < 3; ++k) {
      const Vertex v = network.facet_vertices[facet][k];
      name[k] = is_wall(v) ? std::pair(std::numeric_limits<std::uint64_t>::max(), std::int64_t(wall_number(v)))
                           : std::pair(places[v], vertices.ids[v]);
    }
    std::sort(name.begin(), name.end());
    if (facet == network.throat_facets[throat] || name < least) least = name;
  }
  return least;
}

/// What a way leads to: set i of those cut off is -1 - i, an unknown of the fluid has its name.
using Node = std::int64_t;
constexpr Node node_of_set(int set) { return -1 - static_cast<Node>(set); }

/// A throat out of a set that is cut off.
struct Way {
  double conductance, area;
  Node ends[2];
  ThroatName name;

  bool operator<(const Way& other) const {
    if (conductance != other.conductance) return conductance > other.conductance;
    return area != other.area ? area > other.area : name < other.name;
  }
};

/// Of each unknown its name; those that are never asked for have one that is no other's.
std::vector<Node> names_of(const Unknowns& unknowns, const RowShare* rows) {
  std::vector<Node> names;
  for (int u = 0; u < unknowns.count; ++u) {
    const Node name = rows ? rows->name_of(u) : u;
    names.push_back(name >= 0 ? name : rows->total + static_cast<Node>(rows->borders.size()) + u);
  }
  return names;
}

/// The ways of all ranks, widest first; never through the surface of a body.
std::vector<Way> ways_out(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                          const std::vector<double>& conductances, const std::vector<int>& body, const CutOff& cut,
                          const Unknowns& unknowns, const std::vector<Node>& names, const Share& share) {
  const std::vector<std::uint64_t> places = curve_numbers(vertices);
  std::vector<Way> ways;
  for (int t = 0; t < network.throats(); ++t) {
    const auto& pores = network.throat_pores[t];
    if (!share.owns_pore(pores[0]) || (cut.of_pore[pores[0]] < 0 && cut.of_pore[pores[1]] < 0)) continue;
    if (unknowns.of_pore[pores[0]] < 0 || unknowns.of_pore[pores[1]] < 0) continue;
    if (throat_at_body(network, t, body) == AtBody::surface) continue;
    Way way{conductances[t], throats.area[t], {}, name_of(network, t, vertices, places)};
    for (int side = 0; side < 2; ++side) {
      const int set = cut.of_pore[pores[side]];
      way.ends[side] = set >= 0 ? node_of_set(set) : names[unknowns.of_pore[pores[side]]];
    }
    ways.push_back(way);
  }
  if (share.ranks) {
    Ranks::Bytes bytes;
    append(bytes, ways.data(), ways.size());
    ways.clear();
    for (const Ranks::Bytes& part : share.ranks->gather(bytes))
      for (const Way& way : values_in<Way>(part)) ways.push_back(way);
  }
  std::sort(ways.begin(), ways.end());
  return ways;
}

/// Joins each set to the fluid by the widest way out of it: of each set the unknown of the fluid that it shares or, where
/// no way leads there, the first set that it is joined to.
std::vector<Node> joined_to(const std::vector<Way>& ways, int count) {
  std::map<Node, int> place;
  for (int set = 0; set < count; ++set) place.emplace(node_of_set(set), set);
  std::vector<Node> nodes;
  for (int set = 0; set < count; ++set) nodes.push_back(node_of_set(set));
  for (const Way& way : ways)
    for (const Node end : way.ends)
      if (place.emplace(end, static_cast<int>(nodes.size())).second) nodes.push_back(end);
  DisjointSets sets(static_cast<int>(nodes.size()));
  std::vector<Node> fluid(nodes.size(), none);
  for (std::size_t i = 0; i < nodes.size(); ++i) fluid[i] = std::max<Node>(nodes[i], none);
  for (const Way& way : ways) {
    const int a = sets.find(place.at(way.ends[0])), b = sets.find(place.at(way.ends[1]));
    if (a == b || (fluid[a] >= 0 && fluid[b] >= 0)) continue;
    const Node reached = std::max(fluid[a], fluid[b]);
    sets.join(a, b);
    fluid[sets.find(a)] = reached;
  }
  std::vector<Node> joined;
  for (int set = 0; set < count; ++set) {
    const int root = sets.find(set);  // the first of its sets
    joined.push_back(fluid[root] >= 0 ? fluid[root] : nodes[root]);
  }
  return joined;
}

/// A set that holds the pressure of a flux boundary makes those that it is joined to pores of that boundary.
std::map<Node, Node> taken_by_borders(const CutOff& cut, const std::vector<Node>& joined, const Unknowns& unknowns,
                                      const std::vector<Node>& names, const Share& share, const RowShare& rows) {
  Eigen::VectorXd border = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(joined.size()), none);
  for (std::size_t pore = 0; pore < cut.of_pore.size(); ++pore)
    if (const int set = cut.of_pore[pore]; set >= 0 && share.own_pores[pore])
      if (const Node name = names[unknowns.of_pore[pore]]; name >= rows.total)
        border[set] = std::max(border[set], static_cast<double>(name));
  share.ranks->take_largest(border.data(), static_cast<std::size_t>(border.size()));
  std::map<Node, Node> taken;
  for (std::size_t set = 0; set < joined.size(); ++set)
    if (const double own = border[static_cast<Eigen::Index>(set)]; own >= 0.0 && joined[set] < rows.total)
      taken[joined[set]] = static_cast<Node>(own);
  return taken;
}

/// Who has the row of what sets are joined to; `none` of a border.
int owner_of(Node joined, const std::vector<double>& ranks_of_sets, const RowShare& rows) {
  if (joined >= rows.total) return none;
  return joined >= 0 ? rows.rank_of(joined) : static_cast<int>(ranks_of_sets[static_cast<std::size_t>(-1 - joined)]);
}

/// The rank that holds the first unknown of each set.
std::vector<double> ranks_of(const CutOff& cut, const Share& share) {
  std::vector<double> ranks;
  for (const Isolated& set : cut.sets) ranks.push_back(set.unknown >= 0 && share.ranks ? share.ranks->own() : none);
  if (share.ranks) share.ranks->take_largest(ranks.data(), ranks.size());
  return ranks;
}

/// Numbers the unknowns anew in the order of the pores; `names`: of each old one, alike where they are one. Returns the new
/// one of each of these that sets are joined to.
std::map<Node, int> renumber(Unknowns& unknowns, const std::vector<Node>& names, const std::vector<Node>& joined) {
  std::map<Node, int> shared;
  for (const Node node : joined) shared.emplace(node, none);
  std::vector<int> fresh(unknowns.count, none);
  unknowns.count = 0;
  const auto number = [&](int& unknown) {
    if (unknown < 0) return;
    const auto found = shared.find(names[unknown]);
    int& own = found == shared.end() ? fresh[unknown] : found->second;
    if (own < 0) own = unknowns.count++;
    unknown = own;
  };
  for (int& unknown : unknowns.of_pore) number(unknown);
  for (int& unknown : unknowns.of_boundary) number(unknown);
  return shared;
}

void join_sets(const CutOff& cut, std::vector<Node> joined, const Share& share, const RowShare* rows, Unknowns& unknowns) {
  std::vector<Node> names = names_of(unknowns, rows);
  if (rows) {
    const std::map<Node, Node> taken = taken_by_borders(cut, joined, unknowns, names, share, *rows);
    for (std::vector<Node>* nodes : {&names, &joined})
      for (Node& node : *nodes)
        if (const auto found = taken.find(node); found != taken.end()) node = found->second;
  }
  for (std::size_t pore = 0; pore < cut.of_pore.size(); ++pore)
    if (cut.of_pore[pore] >= 0) names[unknowns.of_pore[pore]] = joined[cut.of_pore[pore]];
  const std::map<Node, int> shared = renumber(unknowns, names, joined);
  if (!rows) return;
  const std::vector<double> ranks_of_sets = ranks_of(cut, share);
  for (const auto& [name, unknown] : shared)
    if (const int owner = owner_of(name, ranks_of_sets, *rows); unknown >= 0 && owner >= 0)
      unknowns.shared.push_back({unknown, owner, name});
}

/// What is no fluid has no way out.
void close_throats_of(const std::vector<int>& enclosed, const PoreNetwork& network, std::vector<double>& conductances) {
  std::vector<char> closed(network.pores(), 0);
  for (const int pore : enclosed) closed[pore] = 1;
  for (int t = 0; t < network.throats(); ++t)
    if (closed[network.throat_pores[t][0]] || closed[network.throat_pores[t][1]]) conductances[t] = 0.0;
}

}  // namespace

ClosedPores take_out_closed_pores(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                                  const std::vector<int>& bodies, const Share& share, const RowShare* rows,
                                  std::vector<double>& conductances, Unknowns& unknowns) {
  const std::vector<int> body = with_stuck_grains(network, vertices, bodies, share);
  CutOff cut = cut_off_pores(network, throats, conductances, body, unknowns, share, rows);
  if (cut.sets.empty()) return {};
  take_out_enclosed(network, surroundings_of(network, cut, body, share), cut, unknowns);
  close_throats_of(unknowns.enclosed_pores, network, conductances);
  double enclosed = 0.0, joined = 0.0;
  for (const int pore : unknowns.enclosed_pores) enclosed += share.owns_pore(pore);
  for (int pore = 0; pore < network.pores(); ++pore) joined += cut.of_pore[pore] >= 0 && share.owns_pore(pore);
  const std::vector<Node> names = names_of(unknowns, rows);
  const std::vector<Way> ways = ways_out(network, throats, vertices, conductances, body, cut, unknowns, names, share);
  join_sets(cut, joined_to(ways, static_cast<int>(cut.sets.size())), share, rows, unknowns);
  return {static_cast<int>(share.sum(enclosed)), static_cast<int>(share.sum(joined))};
}

}  // namespace pfv
