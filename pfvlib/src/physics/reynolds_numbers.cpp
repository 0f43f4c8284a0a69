// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/reynolds_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// Of the spheres of a throat's facets, each facet's counted, m.
double mean_diameter(const PoreNetwork& network, const Spheres& vertices, int throat) {
  double sum = 0.0;
  int count = 0;
  for (int f = network.throat_facets[throat]; f < network.throat_facets[throat + 1]; ++f)
    for (const Vertex vertex : network.facet_vertices[f])
      if (!is_wall(vertex)) {
        sum += vertices.radii[vertex];
        ++count;
      }
  return 2.0 * sum / count;
}

}  // namespace

ReynoldsNumbers reynolds_numbers(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                                 const Conductances& conductances, const std::vector<double>& fluxes, double density,
                                 double viscosity, const Share& share) {
  double largest = 0.0, sum = 0.0, power = 0.0;
  for (int t = 0; t < network.throats(); ++t) {
    const double area = throats.area[t], conductance = conductances.value[t];
    if (!(area > 0.0) || !(conductance > 0.0) || !share.owns_pore(network.throat_pores[t][0])) continue;
    const double flux = std::abs(fluxes[t]);
    const double reynolds = density * flux / area * mean_diameter(network, vertices, t) / viscosity;
    const double lost = flux * flux / conductance;
    largest = std::max(largest, reynolds);
    sum += lost * reynolds;
    power += lost;
  }
  sum = share.sum(sum);
  power = share.sum(power);
  return {share.largest(largest), power > 0.0 ? sum / power : 0.0};
}

}  // namespace pfv
