// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/pore_velocities.hpp"

#include "network/facets.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// A piece of a pore's surface.
struct SurfacePiece {
  int pore;
  Eigen::Vector3d middle;
  double area;
  double outflow;
};

/// The pieces of the throats; the flow of a throat is spread over its facets by area.
void add_facets(const PoreNetwork& network, const Spheres& spheres,
                const std::vector<double>& fluxes, std::vector<SurfacePiece>& sides) {
  for (int t = 0; t < network.throats(); ++t) {
    double total = 0.0;
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      total += area_vector(network.facet_vertices[f], spheres).norm();
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const double area = area_vector(network.facet_vertices[f], spheres).norm();
      const double flow = total > 0.0 ? fluxes[t] * area / total : 0.0;
      const Eigen::Vector3d middle = facet_middle(network.facet_vertices[f], spheres);
      sides.push_back({network.throat_pores[t][0], middle, area, flow});
      sides.push_back({network.throat_pores[t][1], middle - network.throat_offset(t), area, -flow});
    }
  }
}

/// A wall's outward normal at the middle of the cell's spheres.
Eigen::Vector3d outward_at(const std::array<Vertex, 4>& cell, int wall, const Spheres& spheres) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4 && !is_wall(cell[i]); ++i) sum += spheres.outward(cell[i], cell[wall]);
  return spheres.wall(cell[wall]).is_plane() ? spheres.wall(cell[wall]).surface.normal : sum.normalized();
}

/// The pieces on the faces of the container, one a cell and face; what enters through a contact is spread
/// over its cells by area.
void add_bases(const PoreNetwork& network, const Spheres& spheres,
               const PoreBoundaries& boundaries, const std::vector<double>& inflows,
               std::vector<SurfacePiece>& sides) {
  const auto& contacts = boundaries.contacts;
  std::vector<double> total(contacts.size(), 0.0);
  const std::size_t first = sides.size();
  std::vector<std::size_t> contact_of;
  for (int c = 0; c < network.cells(); ++c)
    for (int i = 0; i < 4; ++i) {
      const auto& cell = network.cell_vertices[c];
      if (!is_wall(cell[i])) continue;
      const auto facet = facet_opposite(cell, i);
      const WallSurface& wall = spheres.wall(cell[i]);
      const double area = std::abs(area_vector(facet, spheres).dot(outward_at(cell, i, spheres)));
      const Eigen::Vector3d middle = put_on(wall, facet_middle(facet, spheres));
      const auto contact =
          static_cast<std::size_t>(boundaries.contact_of(network.cell_pore[c], wall_number(cell[i])));
      sides.push_back({network.cell_pore[c], middle, area, 0.0});
      contact_of.push_back(contact);
      total[contact] += area;
    }
  for (std::size_t k = 0; k < contact_of.size(); ++k) {
    SurfacePiece& side = sides[first + k];
    if (total[contact_of[k]] > 0.0)
      side.outflow = -inflows[contact_of[k]] * side.area / total[contact_of[k]];
  }
}

}  // namespace

namespace {

/// Of the two right triangles with the legs u and v that make it up.
Eigen::Vector3d middle_of_kite(const Eigen::Vector3d& start, const WallPair& walls) {
  const Eigen::Vector3d edge = walls.to_edge();
  const double first = walls.u * walls.leg, second = walls.v * walls.second_leg;
  const double sum = first + second;
  if (!(std::abs(sum) > 0.0)) return start + edge / 2.0;
  return start + (first * (walls.u * walls.first + edge) + second * (walls.v * walls.second + edge)) / (3.0 * sum);
}

}  // namespace

Eigen::Vector3d facet_middle(const std::array<Vertex, 3>& facet, const Spheres& spheres) {
  const int a = facet[0];
  const Eigen::Vector3d start = spheres.centres.col(a), second = spheres.towards(a, facet[1]),
                        third = spheres.towards(a, facet[2]);
  if (!is_wall(facet[2])) return start + (second + third) / 3.0;
  const double height = spheres.distance(a, wall_number(facet[2]));
  if (is_wall(facet[1])) {
    const WallPair walls(a, facet[1], facet[2], spheres);
    return walls.c == 0.0 ? Eigen::Vector3d(start + 0.5 * (walls.u * second + height * third))
                          : middle_of_kite(start, walls);
  }
  // two triangles: both centres and the foot of the second, the first centre and both feet
  const double other = spheres.distance(facet[1], wall_number(facet[2]));
  const Eigen::Vector3d first_triangle = (2.0 * second + other * third) / 3.0;
  const Eigen::Vector3d second_triangle = (second + (other + height) * third) / 3.0;
  return start + (other * first_triangle + height * second_triangle) / (other + height);
}

Eigen::Matrix3Xd velocity_integrals(const PoreNetwork& network, const Spheres& spheres,
                                    const PoreBoundaries& boundaries,
                                    const std::vector<double>& fluxes,
                                    const std::vector<double>& inflows) {
  std::vector<SurfacePiece> sides;
  add_facets(network, spheres, fluxes, sides);
  add_bases(network, spheres, boundaries, inflows, sides);
  Eigen::Matrix3Xd middle = Eigen::Matrix3Xd::Zero(3, network.pores());
  Eigen::VectorXd area = Eigen::VectorXd::Zero(network.pores());
  for (const SurfacePiece& side : sides) {
    middle.col(side.pore) += side.area * side.middle;
    area[side.pore] += side.area;
  }
  for (int p = 0; p < network.pores(); ++p)
    if (area[p] > 0.0) middle.col(p) /= area[p];
  Eigen::Matrix3Xd integrals = Eigen::Matrix3Xd::Zero(3, network.pores());
  for (const SurfacePiece& side : sides)
    integrals.col(side.pore) += side.outflow * (side.middle - middle.col(side.pore));
  return integrals;
}

}  // namespace pfv
