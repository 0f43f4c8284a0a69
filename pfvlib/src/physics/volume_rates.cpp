// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/volume_rates.hpp"

#include "physics/cell_volumes.hpp"

#include <algorithm>

namespace pfv {

VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres) {
  VolumeRateMatrix matrix;
  matrix.gradient.reserve(network.cells());
  for (const auto& cell : network.cell_vertices)
    matrix.gradient.push_back(cell_volume(cell, spheres).gradient);
  return matrix;
}

Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const PoreNetwork& network,
                             const Eigen::Matrix3Xd& velocities, const Box& box) {
  std::array<Eigen::Vector3d, 6> wall_velocity;
  for (int face = 0; face < 6; ++face)
    wall_velocity[face] = box.faces[face].velocity * Eigen::Vector3d::Unit(face / 2);
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(network.pores());
  for (int c = 0; c < network.cells(); ++c) {
    double rate = 0.0;
    for (int i = 0; i < 4; ++i) {
      const Vertex vertex = network.cell_vertices[c][i];
      rate += is_wall(vertex)
                  ? matrix.gradient[c][i].dot(wall_velocity[wall_number(vertex)])
                  : matrix.gradient[c][i].dot(velocities.col(network.vertex_sphere[vertex]));
    }
    rates[network.cell_pore[c]] += rate;
  }
  return rates;
}

std::vector<double> base_areas(const PoreNetwork& network, const PoreBoundaries& boundaries,
                               const Spheres& spheres) {
  const auto& contacts = boundaries.contacts;
  std::vector<double> areas(contacts.size(), 0.0);
  for (int c = 0; c < network.cells(); ++c) {
    const auto& vertices = network.cell_vertices[c];
    if (!is_wall(vertices[3])) continue;  // walls come last
    const CellVolume cell = cell_volume(vertices, spheres);
    for (int i = 1; i < 4; ++i) {
      if (!is_wall(vertices[i])) continue;
      const int face = wall_number(vertices[i]);
      const std::pair<int, int> key{network.cell_pore[c], face};
      const auto contact = std::lower_bound(
          contacts.begin(), contacts.end(), key,
          [](const auto& a, const auto& b) { return std::make_pair(a.pore, a.face) < b; });
      // dV / d(position of the wall) is the area of the cell's base
      areas[contact - contacts.begin()] +=
          cell.gradient[i].dot(outward_normal(static_cast<Face>(face)));
    }
  }
  return areas;
}

}  // namespace pfv
