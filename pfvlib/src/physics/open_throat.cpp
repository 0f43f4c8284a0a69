// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/open_throat.hpp"

#include "geometry/pi.hpp"
#include "network/facets.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

constexpr double half_open_gap = 0.18;       // in sums of radii
constexpr double openness_power = 0.8;
constexpr double even_gap = 1e-3;            // w is linear below: round-off opens nothing
constexpr double wall_share = 2.0 / 3.0;     // of the wall's area that the throat's own fluid meets
constexpr double plate_kozeny = 3.0;         // Poiseuille flow between plates
constexpr double hidden_wall_share = 0.8;    // of the caps beyond walls
constexpr double largest_per_area2 = 1e3;    // bound on mu g / S²
constexpr double closed_share = 1e-12;       // of a row of kites that is fluid

/// Share of a side (between two spheres, or a sphere and a wall) that its gap has opened.
double side_openness(double distance, double radii) {
  const double gap = std::max(0.0, distance / radii - 1.0);
  const double ratio = gap / half_open_gap *
                       std::pow((gap + even_gap) / half_open_gap, openness_power - 1.0);
  return ratio / (1.0 + ratio);
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
  const Eigen::Vector3d normal = unit_normal(facet, spheres);  // of a swept facet its mean
  const bool swept = is_swept(facet, spheres);
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
    const Eigen::Vector3d across = swept ? Eigen::Vector3d((normal - normal.dot(along) * along).normalized()) : normal;
    const Eigen::Vector3d inwards = (turned ? -1.0 : 1.0) * across.cross(along);
    const Eigen::Vector3d first = network.pore_centres.col(pores[0]) - spheres.centres.col(k);
    const Eigen::Vector3d second = network.pore_centres.col(pores[1]) +
                                   network.throat_offset(t) - spheres.centres.col(k);
    const double angle = std::atan2(-across.dot(first), inwards.dot(first)) +
                         std::atan2(across.dot(second), inwards.dot(second));
    const double share = (is_wall(other) ? hidden_wall_share : 1.0) * angle / (2.0 * pi);
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

/// Sums over the facets of a throat.
struct Measures {
  double fluid = 0.0;    ///< pore volume of the domain, each lens once
  double spheres = 0.0;  ///< surface of the spheres, what overlaps hide left out
  double hidden = 0.0;   ///< surface of the spheres that overlaps hide
  double walls = 0.0;    ///< no-slip walls, their share
  double openness = 0.0;
  double mirrored_area = 0.0;  ///< with what slip walls mirror
};

/// Facet f of throat t; its openness counts as its share of an area. What is turned over counts negative in a row.
void add_facet(Measures& sum, const PoreNetwork& network, const Throats& throats, const Spheres& spheres, int t, int f,
               bool in_row) {
  const auto& facet = network.facet_vertices[f];
  std::array<bool, 3> sticks{};
  double area = area_vector(facet, spheres).norm();
  const Hidden hidden = hidden_in_facet(network, spheres, t, f);
  sum.fluid += hidden.volume;
  sum.spheres -= hidden.area;
  sum.hidden += hidden.area;
  for (int i = 0; i < 3; ++i) {
    const double gamma = throats.facet_gamma[f][i];
    sticks[i] = is_wall(facet[i]) && (in_row ? gamma != 0.0 : gamma > 0.0);
    (is_wall(facet[i]) ? sum.walls : sum.spheres) += (sticks[i] ? wall_share : 1.0) * gamma;
  }
  sum.openness += area * facet_openness(facet, sticks, spheres) / (in_row ? 1.0 : throats.area[t]);
  for (int i = 1; i < 3; ++i)
    if (is_wall(facet[i]) && !sticks[i]) area *= 2.0;
  sum.mirrored_area += area;
}

/// A throat, or those of a row as one.
struct Whole {
  Measures sum;
  double area = 0.0, fluid_area = 0.0;
  double domain = 0.0;  ///< its volume, solid included, m³
};

Whole measure(const PoreNetwork& network, const Throats& throats, const Spheres& spheres, int t) {
  Whole whole{{}, throats.area[t], throats.fluid_area[t], domain_of(throats, t)};
  whole.sum.fluid = throats.volume[t];
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
    add_facet(whole.sum, network, throats, spheres, t, f, false);
  return whole;
}

/// Of a kite between the walls that end a row.
double openness_of(const KiteRow& row, const PoreNetwork& network, const Throats& throats, const Spheres& spheres) {
  std::array<bool, 3> sticks{};
  for (const int t : row.throats)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int i = 0; i < 3; ++i)
        for (int end = 0; end < 2; ++end)
          if (network.facet_vertices[f][i] == row.ends[end] && throats.facet_gamma[f][i] != 0.0) sticks[end + 1] = true;
  return facet_openness({row.sphere, row.ends[0], row.ends[1]}, sticks, spheres);
}

Whole measure(const PoreNetwork& network, const Throats& throats, const Spheres& spheres, const KiteRow& row) {
  Whole whole;
  double areas = 0.0;  // none negative
  for (const int t : row.throats) {
    whole.area += throats.area[t];
    whole.fluid_area += throats.fluid_area[t];
    whole.domain += domain_of(throats, t);
    whole.sum.fluid += throats.volume[t];
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      areas += area_vector(network.facet_vertices[f], spheres).norm();
      add_facet(whole.sum, network, throats, spheres, t, f, true);
    }
  }
  whole.sum.openness =
      row.ends[0] != 0 ? openness_of(row, network, throats, spheres) : whole.sum.openness / std::max(areas, whole.area);
  return whole;
}

}  // namespace

OpenThroat open_throat(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                       int t) {
  OpenThroat result;
  const KiteRow* row = throats.kite_rows.of(t);
  const Whole whole = row ? measure(network, throats, spheres, *row) : measure(network, throats, spheres, t);
  const Measures& throat = whole.sum;
  const double area = whole.area, gamma = throat.spheres + throat.walls;
  if (row && !(area > 0.0 && whole.fluid_area > closed_share * area)) {
    result.by_rule = true;
    return result;
  }
  result.by_rule = throat.fluid <= 0.0 || gamma <= 0.0;
  double radius = 0.0, solid = 0.0, kozeny = 0.0;
  if (result.by_rule) {
    const auto& [i, j] = network.throat_pores[t];
    radius = hydraulic_radius_of_pores(throats, network.throat_pores[t]);
    solid = solid_fraction(throats.pore_fluid_volume[i] + throats.pore_fluid_volume[j],
                           throats.pore_volume[i] + throats.pore_volume[j]);
    kozeny = kuwabara_kozeny(solid);
  } else {
    radius = throat.fluid / gamma;
    solid = solid_fraction(throat.fluid, whole.domain);
    const double root = (std::max(0.0, throat.spheres) * std::sqrt(kuwabara_kozeny(solid)) +
                         throat.walls * std::sqrt(plate_kozeny)) / gamma;
    kozeny = root * root;
    result.wall_share = throat.walls / gamma;
    result.hidden_share = std::max(0.0, throat.hidden) / (gamma + std::max(0.0, throat.hidden));
  }
  if (!(radius > 0.0)) return result;
  const double touching = 1.0 / (alpha * whole.fluid_area * radius * radius);
  const double drag = throat.openness * kozeny / (area * (1.0 - solid) * radius * radius);
  result.value = 1.0 / (touching + drag);
  result.drag_share = drag > 0.0 ? drag / (touching + drag) : 0.0;
  const double bound = largest_per_area2 * area * throat.mirrored_area;
  result.at_bound = result.value > bound;
  result.value = std::min(result.value, bound);
  if (row) result.value *= throats.kite_rows.share[t];
  return result;
}

}  // namespace pfv
