// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/built_network.hpp"

#include "geometry/pi.hpp"
#include "network/facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

Eigen::Matrix3Xd unknown_places(const BuiltNetwork& built) {
  Eigen::Matrix3Xd places(3, built.unknowns.count);
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
