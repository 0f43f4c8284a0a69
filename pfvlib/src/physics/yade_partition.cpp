// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/yade_partition.hpp"

#include "geometry/solid_angle.hpp"
#include "network/facets.hpp"

#include <cmath>

namespace pfv {

namespace {

/// Part of a disc about the origin beyond the line through two points.
double segment_beyond(double radius, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const double height = p.cross(q).norm() / (q - p).norm();
  if (height >= radius) return 0.0;
  return radius * radius * std::acos(height / radius) -
         height * std::sqrt(radius * radius - height * height);
}

struct YadeFacet {
  double volume, gamma = 0.0, discs = 0.0, segment = 0.0, wall_factor = 1.0;
};

void add_sphere(YadeFacet& sums, Throats& throats, const Spheres& spheres,
                const std::array<Vertex, 3>& facet, int f, int corner,
                const Eigen::Vector3d& first_pore, const Eigen::Vector3d& second_pore) {
  const int k = facet[corner];
  const Vertex a = facet[(corner + 1) % 3], b = facet[(corner + 2) % 3];
  const double r = spheres.radii[k];
  const Eigen::Vector3d to_a = spheres.towards(k, a), to_b = spheres.towards(k, b);
  const Eigen::Vector3d from_i = first_pore - spheres.centres.col(k);
  const Eigen::Vector3d from_j = second_pore - spheres.centres.col(k);
  const double angle = std::abs(solid_angle(to_a, from_i, from_j)) +
                       std::abs(solid_angle(to_b, from_i, from_j));
  sums.volume -= r * r * r * angle / 3.0;
  sums.gamma += throats.facet_gamma[f][corner] = r * r * angle;
  sums.discs += throats.facet_disc[f][corner] =
      0.5 * r * r * std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b));
  if (sums.segment == 0.0 && !is_wall(a) && !is_wall(b))
    sums.segment = segment_beyond(r, to_a, to_b);
}

}  // namespace

void apply_yade_partition(Throats& throats, const PoreNetwork& network, const Spheres& spheres,
                          const Container& container) {
  throats.conductance_factor.assign(network.throats(), 1.0);
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    const Eigen::Vector3d first = network.pore_centres.col(i);
    const Eigen::Vector3d second = network.pore_centres.col(j) + network.throat_offset(t);
    throats.volume[t] = throats.gamma[t] = throats.fluid_area[t] = 0.0;
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const auto& facet = network.facet_vertices[f];
      const double area = area_vector(facet, spheres).norm();
      YadeFacet sums{area * throats.length[t] / 3.0};
      for (int k = 0; k < 3; ++k) {
        if (!is_wall(facet[k])) {
          add_sphere(sums, throats, spheres, facet, f, k, first, second);
          continue;
        }
        const int face = wall_number(facet[k]);
        if (container.faces[face].wall == Wall::symmetry) sums.wall_factor /= std::sqrt(2.0);
        sums.gamma += throats.facet_gamma[f][k];  // a no-slip wall's strip is the same in both
      }
      throats.volume[t] += sums.volume;
      throats.gamma[t] += sums.gamma;
      throats.fluid_area[t] += std::abs(area - sums.discs + sums.segment);
      throats.conductance_factor[t] = sums.wall_factor;
    }
  }
}

}  // namespace pfv
