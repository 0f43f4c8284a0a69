// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/shear_forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace pfv {

namespace {

/// What one facet of the triangulation adds to the pair of spheres on one of its edges.
struct Side {
  std::pair<int, int> spheres;  ///< the lower column first
  double area;                  ///< signed: twice the triangles add up to twice the facet of the pair
  double volume, surface;       ///< phi and gamma of its throat; 0 within a merged pore
};

/// The triangle that the line between the facet's two cell centres spans with the pair's axis, positive
/// where it turns about the axis by the right-hand rule, as all of them do around a convex facet.
double signed_area(const PoreNetwork& network, const Spheres& spheres, int f, int low, int high) {
  const Eigen::Vector3d axis = (spheres.centres.col(high) - spheres.centres.col(low)).normalized();
  const Eigen::Vector3d origin = spheres.centres.col(low);
  const auto [from, to] = network.facet_cells[f];
  return 0.5 * (network.cell_centres.col(from) - origin)
                   .cross(network.cell_centres.col(to) - origin)
                   .dot(axis);
}

std::vector<Side> sides_of(const PoreNetwork& network, const Throats& throats,
                           const Spheres& spheres) {
  std::vector<Side> sides;
  int t = 0;
  for (int f = 0; f < network.facets(); ++f) {
    while (t < network.throats() && f >= network.throat_facets[t + 1]) ++t;
    const bool in_throat = t < network.throats();
    for (int k = 0; k < 3; ++k) {
      const Vertex a = network.facet_vertices[f][k], b = network.facet_vertices[f][(k + 1) % 3];
      if (is_wall(a) || is_wall(b)) continue;
      const auto [low, high] = std::minmax(a, b);
      const double turn = a < b ? 1.0 : -1.0;
      sides.push_back({{low, high},
                       turn * signed_area(network, spheres, f, low, high),
                       in_throat ? throats.volume[t] : 0.0,
                       in_throat ? throats.gamma[t] : 0.0});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.spheres < b.spheres; });
  return sides;
}

}  // namespace

std::vector<ShearPair> shear_pairs(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres) {
  const std::vector<Side> sides = sides_of(network, throats, spheres);
  std::vector<ShearPair> pairs;
  for (std::size_t first = 0; first < sides.size();) {
    double area = 0.0, volume = 0.0, surface = 0.0;
    std::size_t last = first;
    for (; last < sides.size() && sides[last].spheres == sides[first].spheres; ++last) {
      area += sides[last].area;
      volume += sides[last].volume;
      surface += sides[last].surface;
    }
    const auto [low, high] = sides[first].spheres;
    if (area > 0.0 && volume > 0.0 && surface > 0.0)
      pairs.push_back({low, high, area, volume / surface,
                       (spheres.centres.col(high) - spheres.centres.col(low)).normalized()});
    first = last;
  }
  return pairs;
}

Eigen::Matrix3d resistance_of(const ShearPair& pair, double viscosity) {
  return viscosity / pair.hydraulic_radius * pair.area *
         (Eigen::Matrix3d::Identity() - pair.direction * pair.direction.transpose());
}

Eigen::Matrix3Xd shear_forces(const std::vector<ShearPair>& pairs, double viscosity,
                              const Eigen::Ref<const Eigen::Matrix3Xd>& velocities) {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, velocities.cols());
  for (const ShearPair& pair : pairs) {
    const Eigen::Vector3d relative = velocities.col(pair.second) - velocities.col(pair.first);
    const Eigen::Vector3d sliding = relative - relative.dot(pair.direction) * pair.direction;
    const Eigen::Vector3d force = viscosity / pair.hydraulic_radius * pair.area * sliding;
    forces.col(pair.first) += force;
    forces.col(pair.second) -= force;
  }
  return forces;
}

}  // namespace pfv
