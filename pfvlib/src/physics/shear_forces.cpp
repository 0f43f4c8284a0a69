// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/shear_forces.hpp"

#include "network/periodic_images.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace pfv {

namespace {

/// Of two spheres, the lower column first.
struct Pair {
  int low, high;
  std::array<int, 3> periods;  ///< from the upper sphere to the image that stands beside the lower one

  bool operator<(const Pair& other) const {
    return std::tie(low, high, periods) < std::tie(other.low, other.high, other.periods);
  }
  bool operator==(const Pair& other) const { return !(*this < other) && !(other < *this); }
};

/// What one facet of the triangulation adds to the pair of spheres on one of its edges.
struct Side {
  Pair pair;
  Eigen::Vector3d axis;     ///< unit vector from the lower one to the upper one
  double area;              ///< signed: twice the triangles add up to twice the facet of the pair
  double volume, surface;   ///< phi and gamma of its throat; 0 within a merged pore
};

/// A facet between two cells, whose centres are those of its pores where it reaches into an image.
struct CutFacet {
  Eigen::Vector3d from, to;
  double volume, surface;
};

CutFacet facet_of(const PoreNetwork& network, const Throats& throats, int f, int throat) {
  const bool in_throat = throat < network.throats();
  CutFacet facet{{}, {}, in_throat ? throats.volume[throat] : 0.0, in_throat ? throats.gamma[throat] : 0.0};
  const auto [from, to] = network.facet_cells[f];
  if (network.throat_offsets.cols() > 0) {
    const auto [first, second] = network.throat_pores[throat];
    facet.from = network.pore_centres.col(first);
    facet.to = network.pore_centres.col(second) + network.throat_offset(throat);
  } else {
    facet.from = network.cell_centres.col(from);
    facet.to = network.cell_centres.col(to);
  }
  return facet;
}

/// The triangle that the line between the facet's two cell centres spans with the pair's axis, positive
/// where it turns about the axis by the right-hand rule, as all of them do around a convex facet.
Side side_of(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices, const CutFacet& facet,
             Vertex a, Vertex b) {
  const bool as_listed = network.vertex_sphere[a] < network.vertex_sphere[b];
  const Vertex low = as_listed ? a : b, high = as_listed ? b : a;
  const Eigen::Vector3d origin = vertices.centres.col(low);
  const Eigen::Vector3d axis = (vertices.centres.col(high) - origin).normalized();
  const double area = 0.5 * (facet.from - origin).cross(facet.to - origin).dot(axis);
  std::array<int, 3> periods = periods_of(network, spheres, vertices, high);
  const std::array<int, 3> of_low = periods_of(network, spheres, vertices, low);
  for (int k = 0; k < 3; ++k) periods[k] -= of_low[k];
  return {{network.vertex_sphere[low], network.vertex_sphere[high], periods},
          axis,
          (as_listed ? 1.0 : -1.0) * area,
          facet.volume,
          facet.surface};
}

int body_of(const std::vector<int>& body, int sphere) { return body.empty() ? -1 : body[sphere]; }

/// A crease or the inside of a body.
bool two_of_a_body(const PoreNetwork& network, const std::array<Vertex, 3>& facet, const std::vector<int>& body) {
  std::array<int, 3> own{};
  for (int k = 0; k < 3; ++k) own[k] = is_wall(facet[k]) ? -1 : body_of(body, network.vertex_sphere[facet[k]]);
  return (own[0] >= 0 && (own[0] == own[1] || own[0] == own[2])) || (own[1] >= 0 && own[1] == own[2]);
}

std::vector<Side> sides_of(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                           const Spheres& vertices, const std::vector<int>& body) {
  std::vector<Side> sides;
  int t = 0;
  for (int f = 0; f < network.facets(); ++f) {
    while (t < network.throats() && f >= network.throat_facets[t + 1]) ++t;
    CutFacet facet = facet_of(network, throats, f, t);
    if (two_of_a_body(network, network.facet_vertices[f], body)) facet.volume = facet.surface = 0.0;
    for (int k = 0; k < 3; ++k) {
      const Vertex a = network.facet_vertices[f][k], b = network.facet_vertices[f][(k + 1) % 3];
      if (is_wall(a) || is_wall(b) || network.vertex_sphere[a] == network.vertex_sphere[b]) continue;
      sides.push_back(side_of(network, spheres, vertices, facet, a, b));
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.pair < b.pair; });
  return sides;
}

/// The facet of the power diagram between two spheres, and the throats around it.
struct SharedFacet {
  Pair pair;
  Eigen::Vector3d axis;
  double area, volume, surface;
};

/// Of all pairs but those within one body, which moves as one.
std::vector<SharedFacet> shared_facets(const std::vector<Side>& sides, const std::vector<int>& body) {
  std::vector<SharedFacet> shared;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    SharedFacet sum{sides[first].pair, sides[first].axis, 0.0, 0.0, 0.0};
    for (; last < sides.size() && sides[last].pair == sum.pair; ++last) {
      sum.area += sides[last].area;
      sum.volume += sides[last].volume;
      sum.surface += sides[last].surface;
    }
    const int own = body_of(body, sum.pair.low);
    if (own < 0 || own != body_of(body, sum.pair.high)) shared.push_back(sum);
  }
  return shared;
}

/// Sums over the throats around a sphere's facets with all spheres of a body: (sphere, body) -> (phi, gamma).
using Contacts = std::map<std::pair<int, int>, std::pair<double, double>>;

Contacts contacts_with_bodies(const std::vector<SharedFacet>& shared, const std::vector<int>& body) {
  Contacts contacts;
  if (body.empty()) return contacts;
  for (const SharedFacet& one : shared)
    for (const auto& [sphere, other] : {std::pair(one.pair.low, one.pair.high), std::pair(one.pair.high, one.pair.low)}) {
      if (body[other] < 0) continue;
      auto& [volume, surface] = contacts[{sphere, body[other]}];
      volume += one.volume;
      surface += one.surface;
    }
  return contacts;
}

/// Owners know all the throats around a sphere; the others are told.
void refresh(Contacts& contacts, const Share& share) {
  struct Told {
    int place, body;  ///< of the sphere in the list that both ranks have
    double volume, surface;
  };
  std::vector<Ranks::Bytes> to(share.spheres.sent.size());
  for (std::size_t rank = 0; rank < to.size(); ++rank)
    for (std::size_t k = 0; k < share.spheres.sent[rank].size(); ++k) {
      const int sphere = share.spheres.sent[rank][k];
      for (auto own = contacts.lower_bound({sphere, 0}); own != contacts.end() && own->first.first == sphere; ++own) {
        const Told told{static_cast<int>(k), own->first.second, own->second.first, own->second.second};
        append(to[rank], &told, 1);
      }
    }
  const std::vector<Ranks::Bytes> from = share.ranks->hand_over(to);
  for (std::size_t rank = 0; rank < from.size(); ++rank)
    for (const Told& told : values_in<Told>(from[rank]))
      contacts[{share.spheres.received[rank][static_cast<std::size_t>(told.place)], told.body}] = {told.volume, told.surface};
}

/// R_h of the throats around a pair. How a body is divided into spheres means nothing to the fluid: at a body the throats
/// around all its spheres beside the other sphere count. Those around one of them may be creases with next to no
/// fluid, and throats with two of its spheres, whose volumes are differences of larger ones, do not count at all.
double hydraulic_radius_at(const SharedFacet& shared, const Contacts& contacts, const std::vector<int>& body) {
  double volume = 0.0, surface = 0.0;
  const auto& [low, high, periods] = shared.pair;
  for (const auto& [sphere, other] : {std::pair(low, high), std::pair(high, low)}) {
    const auto contact = contacts.find({sphere, body_of(body, other)});
    volume += contact == contacts.end() ? shared.volume : contact->second.first;
    surface += contact == contacts.end() ? shared.surface : contact->second.second;
  }
  return surface > 0.0 ? volume / surface : 0.0;
}

}  // namespace

std::vector<ShearPair> shear_pairs(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                                   const Spheres& vertices, const std::vector<int>& body, const Share& share) {
  const std::vector<SharedFacet> shared = shared_facets(sides_of(network, throats, spheres, vertices, body), body);
  Contacts contacts = contacts_with_bodies(shared, body);
  if (share.ranks && !body.empty()) refresh(contacts, share);
  std::vector<ShearPair> pairs;
  for (const SharedFacet& one : shared) {
    const auto& [low, high, periods] = one.pair;
    const double hydraulic_radius = hydraulic_radius_at(one, contacts, body);
    if (one.area > 0.0 && hydraulic_radius > 0.0)
      pairs.push_back({low, high, Eigen::Vector3i(periods[0], periods[1], periods[2]), one.area, hydraulic_radius, one.axis});
  }
  return pairs;
}

void add_blocks(const std::vector<ShearPair>& pairs, double viscosity, std::vector<ResistanceBlock>& blocks) {
  for (const ShearPair& pair : pairs) {
    const Eigen::Matrix3d resistance = viscosity / pair.hydraulic_radius * pair.area *
                                       (Eigen::Matrix3d::Identity() - pair.direction * pair.direction.transpose());
    blocks.push_back({pair.first, pair.first, resistance});
    blocks.push_back({pair.second, pair.second, resistance});
    blocks.push_back({pair.first, pair.second, -resistance});
    blocks.push_back({pair.second, pair.first, -resistance});
  }
}

Eigen::Matrix3Xd shear_forces(const std::vector<ShearPair>& pairs, double viscosity,
                              const Eigen::Ref<const Eigen::Matrix3Xd>& velocities,
                              const Eigen::Matrix3d& of_periods) {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, velocities.cols());
  for (const ShearPair& pair : pairs) {
    Eigen::Vector3d relative = velocities.col(pair.second) - velocities.col(pair.first);
    if (!pair.periods.isZero()) relative += of_periods * pair.periods.cast<double>();
    const Eigen::Vector3d sliding = relative - relative.dot(pair.direction) * pair.direction;
    const Eigen::Vector3d force = viscosity / pair.hydraulic_radius * pair.area * sliding;
    forces.col(pair.first) += force;
    forces.col(pair.second) -= force;
  }
  return forces;
}

}  // namespace pfv
