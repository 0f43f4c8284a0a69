// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/conductances.hpp"

#include "geometry/pi.hpp"
#include "physics/isotropic_drag.hpp"
#include "physics/open_throat.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// R_h beyond this many facet sizes sqrt(S) resists nothing in either case, but spreads the
/// conductances beyond what double precision can factor (spheres 1e4 times smaller than a pore).
constexpr double widest_in_facet_sizes = 100.0;

/// phi / gamma of the throat or, where that has no meaning, of its two pores; <= 0 where none has.
double hydraulic_radius(const Throats& throats, const std::array<int, 2>& pores, int t,
                        bool& by_rule) {
  by_rule = throats.volume[t] <= 0.0 || throats.gamma[t] <= 0.0;
  if (by_rule) return hydraulic_radius_of_pores(throats, pores);
  const double radius = throats.volume[t] / throats.gamma[t];
  const double widest = widest_in_facet_sizes * std::sqrt(throats.area[t]);
  by_rule = radius > widest;
  return std::min(radius, widest);
}

/// Radius of the circle in the facet's plane that touches its three spheres and walls. Its centre x
/// (from the first sphere) is linear in its radius s: from |x - x_i| = s + r_i less |x| = s + r_0,
/// and w . x = h - s for a wall; |x| = s + r_0 then leaves a quadratic equation.
double inscribed_radius(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const int first = facet[0];
  const double r0 = spheres.radii[first];
  const Eigen::Vector3d normal =
      spheres.towards(first, facet[1]).cross(spheres.towards(first, facet[2]));
  const double length2 = normal.squaredNorm();
  if (length2 == 0.0) return 0.0;
  std::array<Eigen::Vector3d, 2> row;
  std::array<double, 2> constant, slope;
  for (int i = 0; i < 2; ++i) {
    const Vertex vertex = facet[i + 1];
    row[i] = spheres.towards(first, vertex);
    if (is_wall(vertex)) {
      constant[i] = spheres.distance(first, wall_number(vertex));
      slope[i] = -1.0;
    } else {
      const double r = spheres.radii[vertex];
      constant[i] = 0.5 * (row[i].squaredNorm() + (r0 - r) * (r0 + r));
      slope[i] = r0 - r;
    }
  }
  const Eigen::Vector3d to_first = row[1].cross(normal) / length2;
  const Eigen::Vector3d to_second = normal.cross(row[0]) / length2;
  const Eigen::Vector3d at_zero = constant[0] * to_first + constant[1] * to_second;
  const Eigen::Vector3d per_radius = slope[0] * to_first + slope[1] * to_second;
  const double a = per_radius.squaredNorm() - 1.0;
  const double b = at_zero.dot(per_radius) - r0;
  const double c = at_zero.squaredNorm() - r0 * r0;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return 0.0;
  // a s² + 2 b s + c = 0 without cancellation; the smallest positive root is the circle in the gap
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double radius = std::numeric_limits<double>::infinity();
  for (const double root : {a != 0.0 ? q / a : -1.0, q != 0.0 ? c / q : -1.0})
    if (root > 0.0) radius = std::min(radius, root);
  return std::isfinite(radius) ? radius : 0.0;
}

/// The circle that touches three spheres almost in a row is as wide as one likes.
constexpr double widest_effective_radius = 5.0;  // in facet sizes sqrt(S)

double effective_radius(const PoreNetwork& network, const Throats& throats,
                        const Spheres& spheres, int t, bool& by_rule) {
  double inscribed = std::numeric_limits<double>::infinity();
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
    inscribed = std::min(inscribed, inscribed_radius(network.facet_vertices[f], spheres));
  const double radius = (std::sqrt(throats.fluid_area[t] / pi) + inscribed) / 4.0;
  const double widest = widest_effective_radius * std::sqrt(throats.area[t]);
  by_rule = radius > widest;
  return std::min(radius, widest);
}

/// A throat that carries less than a pore's other throats lose by round-off: as the only way out of a
/// group of pores it would leave their pressure to chance.
constexpr double least_of_its_pores = 1e-14;

void close_what_round_off_hides(Conductances& conductances, const PoreNetwork& network) {
  std::vector<double> sum(network.pores(), 0.0);
  for (int t = 0; t < network.throats(); ++t)
    for (const int pore : network.throat_pores[t]) sum[pore] += conductances.value[t];
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    double& c = conductances.value[t];
    if (c <= 0.0 || c >= least_of_its_pores * std::min(sum[i], sum[j])) continue;
    c = 0.0;
    conductances.by_rule[t] = 1;
  }
}

}  // namespace

bool is_closed(const Throats& throats, int t) {
  return throats.fluid_area[t] <= 1e-12 * throats.area[t];
}

namespace {

struct Conductance {
  double value = 0.0;
  bool by_rule = false;
};

Conductance conductance_of(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                           const Throats& throats, const Spheres& spheres, int t) {
  const bool as_one = law == ConductanceLaw::open_throat && throats.kite_rows.of(t);
  if (!as_one && is_closed(throats, t)) return {0.0, true};
  const double scale = 1.0 / (viscosity * throats.length[t]);
  Conductance result;
  if (law == ConductanceLaw::effective_radius) {
    const double radius = effective_radius(network, throats, spheres, t, result.by_rule);
    result.value = 2.0 * pi * std::pow(radius, 4) * scale;
  } else if (law == ConductanceLaw::open_throat) {
    const OpenThroat throat = open_throat(network, throats, spheres, t);
    result = {throat.value * scale, throat.by_rule};
  } else {
    const double radius =
        hydraulic_radius(throats, network.throat_pores[t], t, result.by_rule);
    if (radius > 0.0) result.value = alpha * throats.fluid_area[t] * radius * radius * scale;
  }
  return result;
}

}  // namespace

Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres, Team& team) {
  constexpr int piece_size = 512;
  Conductances result;
  result.value.assign(network.throats(), 0.0);
  result.by_rule.assign(network.throats(), 0);
  team.run((network.throats() + piece_size - 1) / piece_size, [&](int piece) {
    const int last = std::min((piece + 1) * piece_size, network.throats());
    for (int t = piece * piece_size; t < last; ++t) {
      const Conductance own = conductance_of(law, viscosity, network, throats, spheres, t);
      result.value[t] = own.value;
      result.by_rule[t] = own.by_rule;
    }
  });
  if (law == ConductanceLaw::open_throat) make_drag_isotropic(network, throats, spheres, result.value);
  close_what_round_off_hides(result, network);
  return result;
}

Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres) {
  Team alone;
  return conductances(law, viscosity, network, throats, spheres, alone);
}

}  // namespace pfv
