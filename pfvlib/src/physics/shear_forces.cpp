// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/shear_forces.hpp"

#include "network/periodic_images.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

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

std::vector<Side> sides_of(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                           const Spheres& vertices) {
  std::vector<Side> sides;
  int t = 0;
  for (int f = 0; f < network.facets(); ++f) {
    while (t < network.throats() && f >= network.throat_facets[t + 1]) ++t;
    const CutFacet facet = facet_of(network, throats, f, t);
    for (int k = 0; k < 3; ++k) {
      const Vertex a = network.facet_vertices[f][k], b = network.facet_vertices[f][(k + 1) % 3];
      if (is_wall(a) || is_wall(b) || network.vertex_sphere[a] == network.vertex_sphere[b]) continue;
      sides.push_back(side_of(network, spheres, vertices, facet, a, b));
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.pair < b.pair; });
  return sides;
}

}  // namespace

std::vector<ShearPair> shear_pairs(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                                   const Spheres& vertices) {
  const std::vector<Side> sides = sides_of(network, throats, spheres, vertices);
  std::vector<ShearPair> pairs;
  for (std::size_t first = 0; first < sides.size();) {
    double area = 0.0, volume = 0.0, surface = 0.0;
    std::size_t last = first;
    for (; last < sides.size() && sides[last].pair == sides[first].pair; ++last) {
      area += sides[last].area;
      volume += sides[last].volume;
      surface += sides[last].surface;
    }
    const auto& [low, high, periods] = sides[first].pair;
    if (area > 0.0 && volume > 0.0 && surface > 0.0)
      pairs.push_back({low, high, Eigen::Vector3i(periods[0], periods[1], periods[2]), area, volume / surface,
                       sides[first].axis});
    first = last;
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
