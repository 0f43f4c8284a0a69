// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/built_network.hpp"

#include "geometry/pi.hpp"
#include "network/facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// How many of 0 ... size - 1 are, over all ranks.
template <class Is>
std::int64_t count_of(const BuiltNetwork& built, int size, const Is& is) {
  std::int64_t count = 0;
  for (int i = 0; i < size; ++i) count += is(i);
  return static_cast<std::int64_t>(built.share.sum(static_cast<double>(count)));
}

}  // namespace

std::int64_t pore_count(const BuiltNetwork& built) {
  return count_of(built, built.network.pores(), [&](int pore) { return built.share.owns_pore(pore); });
}

std::int64_t merged_pores(const BuiltNetwork& built) {
  const PoreNetwork& network = built.network;
  return count_of(built, network.cells(), [&](int c) { return built.share.owns_pore(network.cell_pore[c]); }) -
         pore_count(built);
}

std::int64_t degenerate_throats(const BuiltNetwork& built) {
  return count_of(built, built.network.throats(), [&](int t) {
    return built.conductances.by_rule[t] && built.share.owns_pore(built.network.throat_pores[t][0]);
  });
}

std::int64_t hidden_spheres(const BuiltNetwork& built) {
  const std::vector<int>& hidden = built.network.hidden;
  return count_of(built, static_cast<int>(hidden.size()), [&](int i) { return built.share.owns_sphere(hidden[i]); });
}

Spheres own_grains(const BuiltNetwork& built) {
  const Spheres& all = built.grains.spheres;
  if (!built.share.ranks) return all;
  std::vector<int> own;
  for (int k = 0; k < all.size(); ++k)
    if (built.share.own_spheres[k]) own.push_back(k);
  Spheres spheres;
  spheres.edges = all.edges;
  spheres.ids = Packing::Ids(all.ids(own));
  spheres.radii = Eigen::VectorXd(all.radii(own));
  if (all.displaced.size() > 0) spheres.displaced = Eigen::VectorXd(all.displaced(own));
  return spheres;
}

Eigen::Matrix3Xd unknown_places(const BuiltNetwork& built) {
  Eigen::Matrix3Xd places = Eigen::Matrix3Xd::Zero(3, built.unknowns.count);
  for (int p = 0; p < built.network.pores(); ++p) {
    const int unknown = built.unknowns.of_pore[p];
    if (unknown != Unknowns::imposed) places.col(unknown) = built.network.pore_centres.col(p);
  }
  return places;
}

CellExtents cell_extents(const PoreNetwork& network, const Spheres& spheres, int axis) {
  CellExtents extents;
  for (const auto& cell : network.cell_vertices) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto reach = [&](double x) {
      low = std::min(low, x);
      high = std::max(high, x);
    };
    for (const Vertex vertex : cell) {
      if (!is_wall(vertex)) reach(spheres.centres(axis, vertex));
      else  // as far as the feet of the cell's spheres on it
        for (int i = 0; i < 4 && !is_wall(cell[i]); ++i)
          reach(put_on(spheres.wall(vertex), spheres.centres.col(cell[i]))[axis]);
    }
    extents.low.push_back(low);
    extents.high.push_back(high);
  }
  return extents;
}

std::vector<double> strain_volumes(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres) {
  std::vector<double> smallest(network.pores(), std::numeric_limits<double>::infinity());
  for (int c = 0; c < network.cells(); ++c)
    for (const Vertex vertex : network.cell_vertices[c])
      if (!is_wall(vertex)) {
        double& radius = smallest[network.cell_pore[c]];
        radius = std::min(radius, spheres.radii[vertex]);
      }
  std::vector<double> volumes(throats.pore_fluid_volume);
  for (int p = 0; p < network.pores(); ++p)
    volumes[p] = std::max(volumes[p], 0.01 * 4.0 / 3.0 * pi * std::pow(smallest[p], 3));
  return volumes;
}

Eigen::VectorXd storage_volumes(const Throats& throats) {
  Eigen::VectorXd volumes(static_cast<Eigen::Index>(throats.pore_volume.size()));
  for (std::size_t p = 0; p < throats.pore_volume.size(); ++p)
    volumes[static_cast<Eigen::Index>(p)] =
        std::max(throats.pore_fluid_volume[p], 0.01 * throats.pore_volume[p]);
  return volumes;
}

}  // namespace pfv
