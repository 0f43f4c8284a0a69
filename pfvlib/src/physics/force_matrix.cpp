// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/force_matrix.hpp"

#include "geometry/solid_angle.hpp"

#include <algorithm>

namespace pfv {

namespace {

struct Entry {
  int row;
  int pore;
  Eigen::Vector3d value;
};

/// A sphere this many times smaller than the largest of its facet stands in the open pore, where the
/// flow is faster than at the surfaces that gamma counts. Fitted on the nine-sphere cell and on small
/// spheres in the pores of a random bed (finite elements).
constexpr double small_sphere_ratio = 4.0;

std::array<double, 3> small_sphere_weights(const std::array<Vertex, 3>& facet,
                                           const Spheres& spheres) {
  std::array<double, 3> weights{1.0, 1.0, 1.0};
  double largest = 0.0;
  for (const Vertex vertex : facet)
    if (!is_wall(vertex)) largest = std::max(largest, spheres.radii[vertex]);
  for (int k = 0; k < 3; ++k)
    if (!is_wall(facet[k]))
      weights[k] = std::max(1.0, largest / (small_sphere_ratio * spheres.radii[facet[k]]));
  return weights;
}

/// Divides the shares of a throat by their sum; among its spheres alike where that is 0.
void normalise(ViscousShares& shares, const PoreNetwork& network, int t) {
  const int begin = network.throat_facets[t], end = network.throat_facets[t + 1];
  double sum = 0.0;
  for (int f = begin; f < end; ++f)
    for (const double share : shares[f]) sum += share;
  if (sum > 0.0) {
    for (int f = begin; f < end; ++f)
      for (double& share : shares[f]) share /= sum;
    return;
  }
  int count = 0;
  for (int f = begin; f < end; ++f)
    for (const Vertex vertex : network.facet_vertices[f]) count += !is_wall(vertex);
  for (int f = begin; f < end; ++f)
    for (int k = 0; k < 3; ++k)
      shares[f][k] = is_wall(network.facet_vertices[f][k]) ? 0.0 : 1.0 / count;
}

/// Visits (row, throat, area) for every facet vertex that takes a force.
template <class Visit>
void for_each_share(const PoreNetwork& network, const Throats& throats,
                    const ViscousShares& shares, int spheres, ForceParts parts, Visit&& visit) {
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        const Vertex vertex = network.facet_vertices[f][k];
        double area = 0.0;
        if (parts.pressure) area += throats.facet_disc[f][k];
        if (parts.viscous) area += throats.fluid_area[t] * shares[f][k];
        if (area != 0.0)
          visit(is_wall(vertex) ? spheres + wall_number(vertex) : network.vertex_sphere[vertex],
                t, area);
      }
}

/// Sorts the entries of each row by pore and adds those of one pore.
ForceMatrix compress(std::vector<int> row_begin, std::vector<int> pore,
                     std::vector<Eigen::Vector3d> value) {
  ForceMatrix matrix;
  const int rows = static_cast<int>(row_begin.size()) - 1;
  matrix.row_begin.reserve(row_begin.size());
  std::vector<int> order;
  int kept = 0;
  for (int row = 0; row < rows; ++row) {
    order.clear();
    for (int e = row_begin[row]; e < row_begin[row + 1]; ++e) order.push_back(e);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pore[a] < pore[b]; });
    const int begin = static_cast<int>(matrix.pore.size());
    for (const int e : order) {
      if (static_cast<int>(matrix.pore.size()) > begin && matrix.pore.back() == pore[e]) {
        matrix.value.col(kept - 1) += value[e];
        continue;
      }
      if (kept == matrix.value.cols())
        matrix.value.conservativeResize(3, std::max(1024, 2 * kept));
      matrix.pore.push_back(pore[e]);
      matrix.value.col(kept++) = value[e];
    }
    matrix.row_begin.push_back(kept);
  }
  matrix.value.conservativeResize(3, kept);
  return matrix;
}

}  // namespace

ViscousShares viscous_shares(ConductanceLaw law, const PoreNetwork& network,
                             const Throats& throats, const Spheres& spheres) {
  ViscousShares shares = throats.facet_gamma;
  for (int t = 0; t < network.throats(); ++t) {
    if (law == ConductanceLaw::open_throat)
      for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
        const auto weights = small_sphere_weights(network.facet_vertices[f], spheres);
        for (int k = 0; k < 3; ++k)  // gamma is signed: what an obtuse domain takes back stays
          if (shares[f][k] > 0.0) shares[f][k] *= weights[k];
      }
    normalise(shares, network, t);
  }
  return shares;
}

ForceMatrix force_matrix(const PoreNetwork& network, const Throats& throats,
                         const ViscousShares& shares, int spheres, ForceParts parts) {
  std::vector<int> row_begin(spheres + 7, 0);
  for_each_share(network, throats, shares, spheres, parts,
                 [&](int row, int, double) { row_begin[row + 1] += 2; });
  for (int row = 0; row < spheres + 6; ++row) row_begin[row + 1] += row_begin[row];
  std::vector<int> next(row_begin.begin(), row_begin.end() - 1);
  std::vector<int> pore(row_begin.back());
  std::vector<Eigen::Vector3d> value(row_begin.back());
  for_each_share(network, throats, shares, spheres, parts, [&](int row, int t, double area) {
    for (int side = 0; side < 2; ++side) {
      const int entry = next[row]++;
      pore[entry] = network.throat_pores[t][side];
      value[entry] = (side == 0 ? area : -area) * throats.normal.col(t);
    }
  });
  return compress(std::move(row_begin), std::move(pore), std::move(value));
}

ForceMatrix energy_force_matrix(const VolumeRateMatrix& rates, int spheres) {
  const auto row_of = [&](Vertex mover) {
    return is_wall(mover) ? spheres + wall_number(mover) : mover;
  };
  ForceMatrix matrix;
  matrix.row_begin.assign(spheres + 7, 0);
  for (const Vertex mover : rates.mover) ++matrix.row_begin[row_of(mover) + 1];
  for (int row = 0; row < spheres + 6; ++row) matrix.row_begin[row + 1] += matrix.row_begin[row];
  matrix.pore.resize(rates.mover.size());
  matrix.value.resize(3, rates.area.cols());
  std::vector<int> next(matrix.row_begin.begin(), matrix.row_begin.end() - 1);
  for (int pore = 0; pore < rates.rows(); ++pore)
    for (int e = rates.row_begin[pore]; e < rates.row_begin[pore + 1]; ++e) {
      const int entry = next[row_of(rates.mover[e])]++;
      matrix.pore[entry] = pore;
      matrix.value.col(entry) = rates.area.col(e);
    }
  return matrix;
}

void multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures, Team& team,
              Eigen::Matrix3Xd& forces) {
  forces.resize(3, matrix.rows());
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, matrix.rows(), [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int e = begin[row]; e < begin[row + 1]; ++e)
        sum += pressures[matrix.pore[e]] * matrix.value.col(e);
      forces.col(row) = sum;
    }
  });
}

Eigen::Matrix3Xd multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures) {
  Team alone;
  Eigen::Matrix3Xd forces;
  multiply(matrix, pressures, alone, forces);
  return forces;
}

Eigen::Matrix3Xd gradient_forces(const PoreNetwork& network, const Throats& throats,
                                 const ViscousShares& shares, int spheres, ForceParts parts,
                                 const Eigen::Vector3d& gradient) {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, spheres + 6);
  for_each_share(network, throats, shares, spheres, parts, [&](int row, int t, double area) {
    forces.col(row) -= area * gradient.dot(network.throat_offset(t)) * throats.normal.col(t);
  });
  return forces;
}

SurfacePressure surface_pressure(const PoreNetwork& network, const Spheres& vertices,
                                 const Spheres& spheres) {
  std::vector<std::vector<std::pair<int, double>>> rows(spheres.size());
  SurfacePressure matrix;
  matrix.offset = Eigen::Matrix3Xd::Zero(3, spheres.size());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i) {
      const double angle = std::abs(solid_angle(vertices.towards(cell[i], cell[(i + 1) % 4]),
                                                vertices.towards(cell[i], cell[(i + 2) % 4]),
                                                vertices.towards(cell[i], cell[(i + 3) % 4])));
      const int sphere = network.vertex_sphere[cell[i]];
      rows[sphere].emplace_back(network.cell_pore[c], angle);
      matrix.offset.col(sphere) +=
          angle * (vertices.centres.col(cell[i]) - spheres.centres.col(sphere));
    }
  }
  for (std::size_t sphere = 0; sphere < rows.size(); ++sphere) {
    const auto& row = rows[sphere];
    double sum = 0.0;
    for (const auto& [pore, angle] : row) sum += angle;
    if (sum > 0.0) matrix.offset.col(static_cast<Eigen::Index>(sphere)) /= sum;
    for (const auto& [pore, angle] : row) {
      matrix.pore.push_back(pore);
      matrix.weight.push_back(angle / sum);
    }
    matrix.row_begin.push_back(static_cast<int>(matrix.pore.size()));
  }
  return matrix;
}

void multiply(const SurfacePressure& matrix, const Eigen::VectorXd& pressures, Team& team,
              Eigen::VectorXd& mean) {
  const int rows = static_cast<int>(matrix.row_begin.size()) - 1;
  mean.resize(rows);
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, rows, [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      double sum = 0.0;
      for (int e = begin[row]; e < begin[row + 1]; ++e)
        sum += matrix.weight[e] * pressures[matrix.pore[e]];
      mean[row] = sum;
    }
  });
}

}  // namespace pfv
