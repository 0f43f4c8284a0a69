// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/volume_rates.hpp"

#include "physics/cell_volumes.hpp"

#include <algorithm>
#include <array>

namespace pfv {

VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres) {
  VolumeRateMatrix matrix;
  std::vector<int>& begin = matrix.row_begin;
  begin.assign(network.pores() + 1, 0);
  for (const int pore : network.cell_pore) begin[pore + 1] += 4;
  for (int pore = 0; pore < network.pores(); ++pore) begin[pore + 1] += begin[pore];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  matrix.mover.resize(begin.back());
  matrix.area.resize(3, begin.back());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& vertices = network.cell_vertices[c];
    const auto gradient = cell_volume(vertices, spheres).gradient;
    for (int i = 0; i < 4; ++i) {
      const int entry = next[network.cell_pore[c]]++;
      matrix.mover[entry] =
          is_wall(vertices[i]) ? vertices[i] : network.vertex_sphere[vertices[i]];
      matrix.area.col(entry) = gradient[i];
    }
  }
  return matrix;
}

void volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& velocities,
                  const Box& box, Team& team, Eigen::VectorXd& rates) {
  std::array<Eigen::Vector3d, 6> wall_velocity;
  for (int face = 0; face < 6; ++face)
    wall_velocity[face] = box.faces[face].velocity * Eigen::Vector3d::Unit(face / 2);
  rates.resize(matrix.rows());
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, matrix.rows(), [&](int first, int last) {
    for (int pore = first; pore < last; ++pore) {
      double rate = 0.0;
      for (int entry = begin[pore]; entry < begin[pore + 1]; ++entry) {
        const Vertex mover = matrix.mover[entry];
        rate += is_wall(mover) ? matrix.area.col(entry).dot(wall_velocity[wall_number(mover)])
                               : matrix.area.col(entry).dot(velocities.col(mover));
      }
      rates[pore] = rate;
    }
  });
}

Eigen::Matrix3Xd with_face_velocities(const Eigen::Matrix3Xd& velocities, const Box& box) {
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, velocities.cols() + 6);
  all.leftCols(velocities.cols()) = velocities;
  for (int face = 0; face < 6; ++face)
    all(face / 2, velocities.cols() + face) = box.faces[face].velocity;
  return all;
}

namespace {

/// Visits (pore, area, velocity) of each mover of each pore.
template <class Visit>
void for_each_mover(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& motion,
                    Visit&& visit) {
  const Eigen::Index walls = motion.cols() - 6;
  for (int pore = 0; pore < matrix.rows(); ++pore)
    for (int entry = matrix.row_begin[pore]; entry < matrix.row_begin[pore + 1]; ++entry) {
      const Vertex mover = matrix.mover[entry];
      visit(pore, matrix.area.col(entry),
            motion.col(is_wall(mover) ? walls + wall_number(mover) : Eigen::Index(mover)));
    }
}

}  // namespace

Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& motion) {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(matrix.rows());
  for_each_mover(matrix, motion, [&](int pore, const auto& area, const auto& velocity) {
    rates[pore] += area.dot(velocity);
  });
  return rates;
}

Eigen::VectorXd gross_volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& motion) {
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(matrix.rows());
  for_each_mover(matrix, motion, [&](int pore, const auto& area, const auto& velocity) {
    gross[pore] += area.norm() * velocity.norm();
  });
  return gross;
}

Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& velocities,
                             const Box& box) {
  Team alone;
  Eigen::VectorXd rates;
  volume_rates(matrix, velocities, box, alone, rates);
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
