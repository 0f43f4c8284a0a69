// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/facets.hpp"
#include "support/stages.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

/// The rules of YADE 2023.02a's FlowEngine, as far as they differ from ours, applied to our
/// network. Written from its documented behaviour and its output, to trace every difference of the
/// results:
/// - the throat's domain is partitioned around the dual edge with unsigned solid angles;
/// - a disc takes its full sector of the facet, overlaps or not; one that crosses the opposite side
///   of its triangle gives the segment beyond it back;
/// - symmetry walls multiply a conductance by 2^(-1/2) per wall of the facet;
/// - walls rub only where they are no-slip walls without a pressure.
namespace support {

struct YadeThroat {
  double conductance = 0.0;  ///< g/L for viscosity 1
  double fluid_area = 0.0;
  std::array<double, 3> sector{};  ///< of each vertex of the facet
  std::array<double, 3> share{};   ///< gamma of each vertex / gamma
};

/// Van Oosterom & Strackee 1983, eq. 8.
inline double signed_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                              b.dot(c) * a.norm() + c.dot(a) * b.norm());
}

/// Part of a disc beyond the line through two points; zero where it does not reach the line.
inline double segment_beyond(double radius, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const double height = p.cross(q).norm() / (q - p).norm();
  if (height >= radius) return 0.0;
  return radius * radius * std::acos(height / radius) -
         height * std::sqrt(radius * radius - height * height);
}

/// Rules that can be switched off one at a time, to see what each of them does.
struct YadeRules {
  bool unsigned_partition = true;
  bool symmetry_factor = true;
};

/// Solid angle of the sector (to_a, to_b) of a facet in the domain of its throat. `from_i` and
/// `from_j` lead from the sphere to the two pores; the facet's normal points from i to j.
inline double wedge_angle(const Eigen::Vector3d& to_a, const Eigen::Vector3d& to_b,
                          const Eigen::Vector3d& from_i, const Eigen::Vector3d& from_j,
                          YadeRules rules) {
  if (rules.unsigned_partition)
    return std::abs(signed_angle(to_a, from_i, from_j)) +
           std::abs(signed_angle(to_b, from_i, from_j));
  return signed_angle(to_a, to_b, from_j) - signed_angle(to_a, to_b, from_i);
}

inline YadeThroat yade_throat(const Stages& s, int facet_number, YadeRules rules = {}) {
  using pfv::is_wall;
  const auto& facet = s.network.facet_vertices[facet_number];
  const auto& cells = s.network.facet_cells[facet_number];
  const Eigen::Vector3d p_i = s.network.cell_centres.col(cells[0]);
  const Eigen::Vector3d p_j = s.network.cell_centres.col(cells[1]);
  const double length = (p_j - p_i).norm();
  const double area = pfv::area_vector(facet, s.spheres).norm();
  YadeThroat throat;
  double volume = area * length / 3.0, gamma = 0.0, solid = 0.0, segment = 0.0;
  double wall_factor = 1.0;
  for (int i = 0; i < 3; ++i) {
    const int v = facet[i];
    const int a = facet[(i + 1) % 3], b = facet[(i + 2) % 3];
    if (is_wall(v)) {
      const pfv::ContainerFace& face = s.box.faces[pfv::wall_number(v)];
      if (rules.symmetry_factor && face.wall == pfv::Wall::symmetry)
        wall_factor /= std::sqrt(2.0);
      if (face.wall != pfv::Wall::no_slip ||
          face.boundary.is_open())
        continue;
      const Eigen::Vector3d normal = pfv::outward_normal(pfv::Face(pfv::wall_number(v)));
      const int other = is_wall(a) ? a : b;
      const double side = is_wall(facet[1])
                              ? s.spheres.distance(facet[0], pfv::wall_number(other))
                              : s.spheres.towards(facet[0], facet[1]).cross(normal).norm();
      throat.share[i] = 0.5 * side * length;
      gamma += throat.share[i];
      continue;
    }
    const double r = s.spheres.radii[v];
    const Eigen::Vector3d centre = s.spheres.centres.col(v);
    const Eigen::Vector3d to_a = s.spheres.towards(v, a), to_b = s.spheres.towards(v, b);
    const double w = wedge_angle(to_a, to_b, p_i - centre, p_j - centre, rules);
    volume -= r * r * r * w / 3.0;
    throat.share[i] = r * r * w;
    gamma += r * r * w;
    throat.sector[i] = 0.5 * r * r * std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b));
    solid += throat.sector[i];
    if (segment == 0.0 && !is_wall(a) && !is_wall(b)) segment = segment_beyond(r, to_a, to_b);
  }
  throat.fluid_area = std::abs(area - solid + segment);
  for (double& share : throat.share) share /= gamma;
  const double radius = volume / gamma;
  throat.conductance = wall_factor * throat.fluid_area * radius * radius / (2.0 * length);
  return throat;
}

/// YADE's forces on the spheres for given pore pressures. Its loop leaves out the cells in the
/// eight corners of the box, as if their pressure were zero.
inline Eigen::Matrix3Xd yade_forces(const Stages& s, Eigen::VectorXd pressures) {
  for (int c = 0; c < s.network.cells(); ++c)
    if (pfv::is_wall(s.network.cell_vertices[c][1])) pressures[s.network.cell_pore[c]] = 0.0;
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, s.spheres.size());
  for (int f = 0; f < s.network.facets(); ++f) {
    const auto& facet = s.network.facet_vertices[f];
    const auto& cells = s.network.facet_cells[f];
    const YadeThroat throat = yade_throat(s, f);
    const Eigen::Vector3d push =
        (pressures[s.network.cell_pore[cells[0]]] - pressures[s.network.cell_pore[cells[1]]]) *
        pfv::unit_normal(facet, s.spheres);
    for (int i = 0; i < 3 && !pfv::is_wall(facet[i]); ++i)
      forces.col(facet[i]) += (throat.sector[i] + throat.fluid_area * throat.share[i]) * push;
  }
  return forces;
}

/// One conductance a throat; a throat of several facets gets their sum.
inline std::vector<double> yade_conductances(const Stages& s, YadeRules rules = {}) {
  std::vector<double> values(s.network.throats(), 0.0);
  for (int t = 0; t < s.network.throats(); ++t)
    for (int f = s.network.throat_facets[t]; f < s.network.throat_facets[t + 1]; ++f)
      values[t] += yade_throat(s, f, rules).conductance;
  return values;
}

}  // namespace support
