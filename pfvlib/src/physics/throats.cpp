// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/throats.hpp"

#include "geometry/solid_angle.hpp"
#include "network/facets.hpp"
#include "physics/cell_volumes.hpp"
#include "physics/disc_parts.hpp"
#include "physics/facet_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// Centre of a throat's first or second pore; with periodic axes, of the image at the throat.
Eigen::Vector3d pore_centre(const PoreNetwork& network, int t, int side) {
  const Eigen::Vector3d centre = network.pore_centres.col(network.throat_pores[t][side]);
  return side == 0 ? centre : Eigen::Vector3d(centre + network.throat_offset(t));
}

/// The two pyramids of a facet, on either side.
struct Halves {
  std::array<double, 2> height;             ///< signed distance of P from the facet
  std::array<double, 2> volume{0.0, 0.0};   ///< of the pyramid, solid included
  std::array<double, 2> phi{0.0, 0.0};      ///< minus the wedges of the spheres
  std::array<double, 2> gamma{0.0, 0.0};
  std::array<double, 3> gamma_of_vertex{0.0, 0.0, 0.0};
};

void add_sphere(Halves& halves, const PoreNetwork& network, const Spheres& spheres, int t, int f,
                int corner) {
  const auto& facet = network.facet_vertices[f];
  const int k = facet[corner];
  const double radius = spheres.radii[k];
  const Eigen::Vector3d u = spheres.towards(k, facet[(corner + 1) % 3]);
  const Eigen::Vector3d v = spheres.towards(k, facet[(corner + 2) % 3]);
  for (int side = 0; side < 2; ++side) {
    const Eigen::Vector3d to_centre = pore_centre(network, t, side) - spheres.centres.col(k);
    const double angle = (side == 0 ? -1.0 : 1.0) * solid_angle(u, v, to_centre);
    halves.phi[side] -= radius * radius * radius * angle / 3.0;
    halves.gamma[side] += radius * radius * angle;
    halves.gamma_of_vertex[corner] += radius * radius * angle;
  }
}

/// Halves of a facet without walls.
Halves halves_of(const FacetShape& shape, const std::array<Vertex, 3>& facet,
                 const Spheres& spheres) {
  Halves halves;
  halves.height = shape.height;
  for (int side = 0; side < 2; ++side)
    halves.volume[side] = halves.phi[side] = shape.area * shape.height[side] / 3.0;
  for (int k = 0; k < 3; ++k) {
    const double radius = spheres.radii[facet[k]];
    for (int side = 0; side < 2; ++side) {
      const double angle = shape.solid_angle[k][side];
      halves.phi[side] -= radius * radius * radius * angle / 3.0;
      halves.gamma[side] += radius * radius * angle;
      halves.gamma_of_vertex[k] += radius * radius * angle;
    }
  }
  return halves;
}

/// Of a facet with two walls: the side on one of them, from the foot to the edge with the other, m.
double leg_on(Vertex wall, Vertex other, int k, const Spheres& spheres) {
  const WallPair walls(k, wall, other, spheres);
  return walls.leg / std::sqrt(walls.sine2);
}

/// The strip of wall under one side of the facet, out to P on either side; only where fluid sticks.
void add_wall(Halves& halves, const PoreNetwork& network, const PoreBoundaries& boundaries,
              const Spheres& spheres, int t, int f, int corner) {
  const auto& facet = network.facet_vertices[f];
  const int face = wall_number(facet[corner]);
  const double side_length =
      is_wall(facet[1]) ? leg_on(facet[corner], facet[corner == 1 ? 2 : 1], facet[0], spheres)
                        : spheres.towards(facet[0], facet[1])
                              .cross(spheres.towards(facet[0], facet[2]))
                              .norm();
  for (int side = 0; side < 2; ++side) {
    const int pore = network.throat_pores[t][side];
    if (!(boundaries.no_slip_faces[pore] & face_bit(face))) continue;
    const double area = 0.5 * side_length * halves.height[side];
    halves.gamma[side] += area;
    halves.gamma_of_vertex[corner] += area;
  }
}

/// At a round wall: cones out to it, and the strips between the facet's trace and P, where fluid sticks.
void measure_round_halves(Halves& halves, const PoreNetwork& network, const PoreBoundaries& boundaries,
                          const Spheres& spheres, int t, int f) {
  const auto& facet = network.facet_vertices[f];
  for (int side = 0; side < 2; ++side) {
    const Eigen::Vector3d place = pore_centre(network, t, side);
    if (is_swept(facet, spheres))
      halves.volume[side] = halves.phi[side] =
          (side == 0 ? -1.0 : 1.0) * cone_on_swept(facet, spheres, place);
    const std::array<double, 3> strips = strips_on_walls(facet, spheres, place, side);
    const int pore = network.throat_pores[t][side];
    for (int k = 1; k < 3; ++k) {
      if (!is_wall(facet[k]) || !(boundaries.no_slip_faces[pore] & face_bit(wall_number(facet[k])))) continue;
      halves.gamma[side] += strips[k];
      halves.gamma_of_vertex[k] += strips[k];
    }
  }
}

Halves measure_halves(const PoreNetwork& network, const PoreBoundaries& boundaries,
                      const Spheres& spheres, int t, int f, double area,
                      const Eigen::Vector3d& normal) {
  const auto& facet = network.facet_vertices[f];
  const Eigen::Vector3d corner = spheres.centres.col(facet[0]);
  Halves halves;
  halves.height = {normal.dot(corner - pore_centre(network, t, 0)),
                   normal.dot(pore_centre(network, t, 1) - corner)};
  for (int side = 0; side < 2; ++side)
    halves.volume[side] = halves.phi[side] = area * halves.height[side] / 3.0;
  const bool round = touches_round_wall(facet, spheres);
  if (round) measure_round_halves(halves, network, boundaries, spheres, t, f);
  for (int k = 0; k < 3; ++k) {
    if (!is_wall(facet[k]))
      add_sphere(halves, network, spheres, t, f, k);
    else if (!round)
      add_wall(halves, network, boundaries, spheres, t, f, k);
  }
  return halves;
}

bool any_round_wall(const Spheres& spheres) {
  return std::any_of(spheres.walls.begin(), spheres.walls.end(), [](const WallSurface& wall) { return !wall.is_plane(); });
}

void resize(Throats& throats, const PoreNetwork& network, const Spheres& spheres) {
  throats.round_domain.assign(any_round_wall(spheres) ? network.throats() : 0, 0.0);
  throats.facet_disc.assign(network.facets(), {0.0, 0.0, 0.0});
  throats.facet_gamma.assign(network.facets(), {0.0, 0.0, 0.0});
  throats.normal.resize(3, network.throats());
  for (auto* values : {&throats.area, &throats.fluid_area, &throats.length, &throats.volume,
                       &throats.gamma})
    values->assign(network.throats(), 0.0);
  for (auto* values : {&throats.pore_volume, &throats.pore_fluid_volume, &throats.pore_gamma})
    values->assign(network.pores(), 0.0);
}

void add_to_pores(Throats& throats, const PoreNetwork& network, const Halves& halves, int t) {
  for (int side = 0; side < 2; ++side) {
    const int pore = network.throat_pores[t][side];
    throats.pore_volume[pore] += halves.volume[side];
    throats.pore_fluid_volume[pore] += halves.phi[side];
    throats.pore_gamma[pore] += halves.gamma[side];
  }
}

/// Negative where more of a kite is turned over than not.
double signed_area(const std::array<Vertex, 3>& facet, const Spheres& spheres, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d area = area_vector(facet, spheres);
  return std::copysign(area.norm(), area.dot(normal));
}

/// What discs leave of a facet. Discs do not overlap: what they take beyond the whole is round-off, but for a
/// turned-over kite, whose forces must add up to its area all the same.
double fluid_area_of(double area, double discs) {
  constexpr double round_off = 1e-9;
  const double rest = area - discs;
  return rest < 0.0 && rest > -round_off * std::abs(area) ? 0.0 : rest;
}

/// Walls come last.
bool has_wall(const std::array<Vertex, 3>& facet) { return is_wall(facet[2]); }

/// `shapes` and `halves`: of the throat's facets.
void measure_throat(Throats& throats, const PoreNetwork& network,
                    const PoreBoundaries& boundaries, const Spheres& spheres, int t,
                    const FacetShape* shapes, Halves* halves) {
  double discs = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
    const auto& facet = network.facet_vertices[f];
    const FacetShape& shape = shapes[f - network.throat_facets[t]];
    const bool walled = has_wall(facet);
    const Eigen::Vector3d normal = walled ? unit_normal(facet, spheres) : shape.normal;
    const double area = walled ? signed_area(facet, spheres, normal) : shape.area;
    Halves& half = halves[f - network.throat_facets[t]];
    half = walled ? measure_halves(network, boundaries, spheres, t, f, area, normal)
                  : halves_of(shape, facet, spheres);
    throats.facet_gamma[f] = half.gamma_of_vertex;
    for (int k = 0; k < 3; ++k) {
      if (is_wall(facet[k])) continue;
      double part = walled ? -1.0 : disc_part_of_triangle(facet, k, spheres, shape);
      if (part < 0.0) part = disc_part(facet, k, spheres, normal, area).area;
      discs += throats.facet_disc[f][k] = part;
    }
    throats.area[t] += area;
    throats.volume[t] += half.phi[0] + half.phi[1];
    // of the vertices' own sums, so that their shares of the viscous force add up to one
    for (const double gamma : half.gamma_of_vertex) throats.gamma[t] += gamma;
    sum += area * normal;
  }
  if (network.throat_facets[t + 1] - network.throat_facets[t] == 1 || throats.area[t] == 0.0)
    throats.normal.col(t) =
        has_wall(network.facet_vertices[network.throat_facets[t]])
            ? unit_normal(network.facet_vertices[network.throat_facets[t]], spheres)
            : shapes->normal;
  else
    throats.normal.col(t) = sum / throats.area[t];
  throats.fluid_area[t] = fluid_area_of(throats.area[t], discs);
  throats.length[t] = (pore_centre(network, t, 1) - pore_centre(network, t, 0)).norm();
}

/// `halves`: of the throat's facets. Without what a round wall bulges.
double round_domain_of(const PoreNetwork& network, const Spheres& spheres, int t, const Halves* halves) {
  bool round = false;
  double domain = 0.0;
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
    const Halves& half = halves[f - network.throat_facets[t]];
    domain += half.volume[0] + half.volume[1];
    round = round || touches_round_wall(network.facet_vertices[f], spheres);
  }
  return round ? domain : 0.0;
}

/// Throats first ... last - 1; `halves`: of their facets.
void measure_piece(Throats& throats, const PoreNetwork& network, const PoreBoundaries& boundaries,
                   const Spheres& spheres, int first, int last, Halves* halves) {
  const int first_facet = network.throat_facets[first];
  std::array<int, facet_batch> facets, of;
  std::array<FacetShape, facet_batch> measured;
  std::vector<FacetShape> shapes(network.throat_facets[last] - first_facet);
  int count = 0;
  const auto empty = [&] {
    if (count == 0) return;
    measure_facets(network, spheres, facets.data(), of.data(), count, measured.data());
    for (int i = 0; i < count; ++i) shapes[facets[i] - first_facet] = measured[i];
    count = 0;
  };
  for (int t = first; t < last; ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      if (has_wall(network.facet_vertices[f])) continue;
      facets[count] = f;
      of[count++] = t;
      if (count == facet_batch) empty();
    }
  empty();
  for (int t = first; t < last; ++t) {
    const int begin = network.throat_facets[t] - first_facet;
    measure_throat(throats, network, boundaries, spheres, t, &shapes[begin], &halves[begin]);
    if (!throats.round_domain.empty()) throats.round_domain[t] = round_domain_of(network, spheres, t, &halves[begin]);
  }
}

/// Throats that a thread takes at a time, and those whose halves are kept until they are added to the
/// pores, which is done in order.
constexpr int throats_per_piece = 512, throats_per_round = 32 * throats_per_piece;

/// Calls visit(throat, pore, area) for both sides of each facet at a round wall.
template <class Visit>
void for_each_round_side(const PoreNetwork& network, const Spheres& spheres, Visit&& visit) {
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const auto& facet = network.facet_vertices[f];
      if (!touches_round_wall(facet, spheres)) continue;
      const double area = area_vector(facet, spheres).norm();
      for (const int pore : network.throat_pores[t]) visit(t, pore, area);
    }
}

/// A round wall bulges out beyond the cones from the pores' centres. What it adds to a pore is shared among the
/// facets at the wall by their areas, so that volumes add up to that of the cylinder.
void add_bulges(Throats& throats, const PoreNetwork& network, const Spheres& spheres) {
  std::vector<double> areas(network.pores(), 0.0), bulge(network.pores(), 0.0);
  for_each_round_side(network, spheres, [&](int, int pore, double area) { areas[pore] += area; });
  for (int c = 0; c < network.cells(); ++c)
    if (const int pore = network.cell_pore[c]; areas[pore] > 0.0)
      bulge[pore] += cell_volume(network.cell_vertices[c], spheres).volume;
  for (int pore = 0; pore < network.pores(); ++pore)
    if (areas[pore] > 0.0) bulge[pore] -= throats.pore_volume[pore];
  for_each_round_side(network, spheres, [&](int t, int pore, double area) {
    const double share = bulge[pore] * area / areas[pore];
    throats.volume[t] += share;
    throats.round_domain[t] += share;
    throats.pore_volume[pore] += share;
    throats.pore_fluid_volume[pore] += share;
  });
}

}  // namespace

// Facets inside a merged pore carry no flow; seen from its one centre their two pyramids cancel.
double hydraulic_radius_of_pores(const Throats& throats, const std::array<int, 2>& pores) {
  const double volume =
      throats.pore_fluid_volume[pores[0]] + throats.pore_fluid_volume[pores[1]];
  const double gamma = throats.pore_gamma[pores[0]] + throats.pore_gamma[pores[1]];
  return gamma > 0.0 ? volume / gamma : 0.0;
}

Throats measure_throats(const PoreNetwork& network, const PoreBoundaries& boundaries,
                        const Spheres& spheres, Team& team) {
  Throats throats;
  resize(throats, network, spheres);
  std::vector<Halves> halves;
  for (int first = 0; first < network.throats(); first += throats_per_round) {
    const int last = std::min(first + throats_per_round, network.throats());
    const int first_facet = network.throat_facets[first];
    halves.resize(network.throat_facets[last] - first_facet);
    team.run((last - first + throats_per_piece - 1) / throats_per_piece, [&](int piece) {
      const int begin = first + piece * throats_per_piece, end = std::min(begin + throats_per_piece, last);
      measure_piece(throats, network, boundaries, spheres, begin, end,
                    halves.data() + network.throat_facets[begin] - first_facet);
    });
    for (int t = first; t < last; ++t)
      for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
        add_to_pores(throats, network, halves[f - first_facet], t);
  }
  if (any_round_wall(spheres)) add_bulges(throats, network, spheres);
  throats.kite_rows = find_kite_rows(network, spheres);
  return throats;
}

Throats measure_throats(const PoreNetwork& network, const PoreBoundaries& boundaries,
                        const Spheres& spheres) {
  Team alone;
  return measure_throats(network, boundaries, spheres, alone);
}

}  // namespace pfv
