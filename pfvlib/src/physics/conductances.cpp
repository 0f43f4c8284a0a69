// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/conductances.hpp"

#include "network/facets.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double alpha = 0.5;  // Chareyre et al. 2012, after eq. 9

bool is_closed(const Throats& throats, int t) {
  return throats.fluid_area[t] <= 1e-12 * throats.area[t];
}

double hydraulic_radius_of_pores(const Throats& throats, const std::array<int, 2>& pores) {
  const double volume =
      throats.pore_fluid_volume[pores[0]] + throats.pore_fluid_volume[pores[1]];
  const double gamma = throats.pore_gamma[pores[0]] + throats.pore_gamma[pores[1]];
  return gamma > 0.0 ? volume / gamma : 0.0;
}

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

// ---- open_throat: the constants, and what they were fitted on, stand in conductances.hpp

constexpr double half_open_gap = 0.18;       // in sums of radii
constexpr double wall_share = 2.0 / 3.0;     // of the wall's area that the throat's own fluid meets
constexpr double plate_kozeny = 3.0;         // Poiseuille flow between plates
constexpr double hidden_share = 0.8;         // of what overlaps hide; the neck's wedge is stagnant
constexpr double largest_per_area2 = 10.0;   // bound on mu g / S²

/// Share of a side (between two spheres, or a sphere and a wall) that its gap has opened.
double side_openness(double distance, double radii) {
  const double gap = std::max(0.0, distance / radii - 1.0);
  return gap / (gap + half_open_gap);
}

double side_openness(const Spheres& spheres, int k, Vertex other) {
  const double radius = spheres.radii[k];
  if (is_wall(other)) return side_openness(spheres.distance(k, wall_number(other)), radius);
  return side_openness(spheres.towards(k, other).norm(), radius + spheres.radii[other]);
}

/// Mean openness of the sides of a facet. A triangle's widest side counts as inner (the squares of
/// a lattice come in triangles); a slip wall mirrors the facet, a no-slip wall is a closed side.
double facet_openness(const std::array<Vertex, 3>& facet, const std::array<bool, 3>& sticks,
                      const Spheres& spheres) {
  const int first = facet[0];
  const double a = side_openness(spheres, first, facet[1]);
  const double b = side_openness(spheres, first, facet[2]);
  if (is_wall(facet[1])) return ((sticks[2] ? 1.0 : 2.0) * a + (sticks[1] ? 1.0 : 2.0) * b) / 4.0;
  const double c = side_openness(spheres, facet[1], facet[2]);
  if (is_wall(facet[2])) return ((sticks[2] ? 1.0 : 2.0) * a + b + c) / 4.0;
  return (a + b + c - std::max({a, b, c})) / 2.0;
}

struct Hidden {
  double area = 0.0, volume = 0.0;
};

/// Cap of a ball beyond a plane at the given distance.
Hidden cap(double radius, double distance) {
  const double height = radius - distance;
  return {2.0 * pi * radius * height, pi * height * height * (3.0 * radius - height) / 3.0};
}

/// What the side from sphere k towards `other` hides all around: the caps of the two overlapping
/// spheres (their surface is none, their lens is counted twice), or the cap beyond a wall.
Hidden hidden_at_side(const Spheres& spheres, int k, Vertex other) {
  const double r = spheres.radii[k];
  if (is_wall(other)) {
    const double distance = spheres.distance(k, wall_number(other));
    return distance < r ? cap(r, distance) : Hidden{};
  }
  const double s = spheres.radii[other];
  const double distance = spheres.towards(k, other).norm();
  if (distance >= r + s) return {};
  const double plane = 0.5 * (distance + (r - s) * (r + s) / distance);
  const Hidden one = cap(r, plane), two = cap(s, distance - plane);
  return {one.area + two.area, one.volume + two.volume};
}

/// Surface and volume that overlaps hide in the domain of facet f, by the angle that the domain has
/// around each side; the angles around a side add up to 2 pi, so that nothing is lost or doubled.
Hidden hidden_in_facet(const PoreNetwork& network, const Spheres& spheres, int t, int f) {
  const auto& facet = network.facet_vertices[f];
  const auto& pores = network.throat_pores[t];
  const Eigen::Vector3d normal = unit_normal(facet, spheres);
  Hidden sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (is_wall(facet[i]) && is_wall(facet[j])) continue;
    const bool turned = is_wall(facet[i]);  // seen from the sphere
    const int k = facet[turned ? j : i];
    const Vertex other = facet[turned ? i : j];
    const Hidden around = hidden_at_side(spheres, k, other);
    if (around.area == 0.0) continue;
    const Eigen::Vector3d along = spheres.towards(k, other).normalized();
    const Eigen::Vector3d inwards = (turned ? -1.0 : 1.0) * normal.cross(along);
    const Eigen::Vector3d first = network.pore_centres.col(pores[0]) - spheres.centres.col(k);
    const Eigen::Vector3d second = network.pore_centres.col(pores[1]) +
                                   network.throat_offset(t) - spheres.centres.col(k);
    const double angle = std::atan2(-normal.dot(first), inwards.dot(first)) +
                         std::atan2(normal.dot(second), inwards.dot(second));
    const double share = hidden_share * angle / (2.0 * pi);
    sum.area += share * around.area;
    sum.volume += share * around.volume;
  }
  return sum;
}

/// Kozeny constant of Kuwabara's cell (J. Phys. Soc. Japan 14, 527, 1959) with solid fraction c:
/// drag of a sphere 6 pi mu r U 5 / (5 - 9 s + 5 s³ - s⁶), s³ = c. 4.5 for c -> 1, 1 / (2c) for
/// c -> 0; the form without cancellation.
double kuwabara_kozeny(double solid_fraction) {
  const double s = std::cbrt(solid_fraction);
  const double porosity_factor = 1.0 + s + s * s;  // 1 - c = (1 - s) (1 + s + s²)
  return std::pow(porosity_factor, 3) /
         (2.0 * solid_fraction * (1.0 + 1.2 * s + 0.6 * s * s + 0.2 * s * s * s));
}

/// Kept off 0 and 1: a sliver's signed volumes may give anything.
double solid_fraction(double fluid, double volume) {
  return volume > 0.0 ? std::clamp(1.0 - fluid / volume, 1e-9, 1.0 - 1e-9) : 1.0 - 1e-9;
}

/// What the open-throat law needs of a throat: sums over its facets.
struct OpenThroat {
  double fluid = 0.0;    ///< pore volume of the domain, each lens once
  double spheres = 0.0;  ///< surface of the spheres, what overlaps hide left out
  double walls = 0.0;    ///< no-slip walls, their share
  double openness = 0.0;
  double mirrored_area = 0.0;  ///< with what slip walls mirror
};

OpenThroat measure_open_throat(const PoreNetwork& network, const Throats& throats,
                               const Spheres& spheres, int t) {
  OpenThroat sum;
  sum.fluid = throats.volume[t];
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
    const auto& facet = network.facet_vertices[f];
    std::array<bool, 3> sticks{};
    double area = area_vector(facet, spheres).norm();
    const Hidden hidden = hidden_in_facet(network, spheres, t, f);
    sum.fluid += hidden.volume;
    sum.spheres -= hidden.area;
    for (int i = 0; i < 3; ++i) {
      const double gamma = throats.facet_gamma[f][i];
      sticks[i] = is_wall(facet[i]) && gamma > 0.0;
      (is_wall(facet[i]) ? sum.walls : sum.spheres) += (sticks[i] ? wall_share : 1.0) * gamma;
    }
    sum.openness += area * facet_openness(facet, sticks, spheres) / throats.area[t];
    for (int i = 1; i < 3; ++i)
      if (is_wall(facet[i]) && !sticks[i]) area *= 2.0;
    sum.mirrored_area += area;
  }
  return sum;
}

/// mu g of a throat that is not closed; 0 where neither it nor its pores have a hydraulic radius.
double open_throat(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                   int t, bool& by_rule) {
  const OpenThroat throat = measure_open_throat(network, throats, spheres, t);
  const double area = throats.area[t], gamma = throat.spheres + throat.walls;
  by_rule = throat.fluid <= 0.0 || gamma <= 0.0;
  double radius = 0.0, solid = 0.0, kozeny = 0.0;
  if (by_rule) {
    const auto& [i, j] = network.throat_pores[t];
    radius = hydraulic_radius_of_pores(throats, network.throat_pores[t]);
    solid = solid_fraction(throats.pore_fluid_volume[i] + throats.pore_fluid_volume[j],
                           throats.pore_volume[i] + throats.pore_volume[j]);
    kozeny = kuwabara_kozeny(solid);
  } else {
    radius = throat.fluid / gamma;
    solid = solid_fraction(throat.fluid, area * throats.length[t] / 3.0);
    const double root = (std::max(0.0, throat.spheres) * std::sqrt(kuwabara_kozeny(solid)) +
                         throat.walls * std::sqrt(plate_kozeny)) / gamma;
    kozeny = root * root;
  }
  if (!(radius > 0.0)) return 0.0;
  const double touching = alpha * throats.fluid_area[t] * radius * radius;
  const double open = area * (1.0 - solid) * radius * radius / kozeny;
  return std::min(1.0 / (1.0 / touching + throat.openness / open),
                  largest_per_area2 * area * throat.mirrored_area);
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
    ++conductances.degenerate;
  }
}

}  // namespace

Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres) {
  Conductances result;
  result.value.assign(network.throats(), 0.0);
  for (int t = 0; t < network.throats(); ++t) {
    if (is_closed(throats, t)) {
      ++result.degenerate;
      continue;
    }
    const double scale = 1.0 / (viscosity * throats.length[t]);
    bool by_rule = false;
    if (law == ConductanceLaw::effective_radius) {
      const double radius = effective_radius(network, throats, spheres, t, by_rule);
      if (by_rule) ++result.degenerate;
      result.value[t] = 2.0 * pi * std::pow(radius, 4) * scale;
      continue;
    }
    if (law == ConductanceLaw::open_throat) {
      result.value[t] = open_throat(network, throats, spheres, t, by_rule) * scale;
      if (by_rule) ++result.degenerate;
      continue;
    }
    const double radius = hydraulic_radius(throats, network.throat_pores[t], t, by_rule);
    if (by_rule) ++result.degenerate;
    if (radius > 0.0)
      result.value[t] = alpha * throats.fluid_area[t] * radius * radius * scale;
  }
  close_what_round_off_hides(result, network);
  return result;
}

}  // namespace pfv
