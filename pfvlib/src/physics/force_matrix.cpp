// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/force_matrix.hpp"

#include "geometry/solid_angle.hpp"

#include <algorithm>
#include <cstdint>

namespace pfv {

namespace {

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

/// The part of throat t's area that acts on corner k of its facet f.
double share_of_corner(const Throats& throats, const ViscousShares& shares, ForceParts parts, int t,
                       int f, int k) {
  double area = 0.0;
  if (parts.pressure) area += throats.facet_disc[f][k];
  if (parts.viscous) area += throats.fluid_area[t] * shares[f][k];
  return area;
}

/// Visits (row, throat, facet, corner, area) for every facet vertex that takes a force.
template <class Visit>
void for_each_share(const PoreNetwork& network, const Throats& throats,
                    const ViscousShares& shares, int spheres, ForceParts parts, Visit&& visit) {
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        const Vertex vertex = network.facet_vertices[f][k];
        const double area = share_of_corner(throats, shares, parts, t, f, k);
        if (area != 0.0)
          visit(is_wall(vertex) ? spheres + wall_number(vertex) : network.vertex_sphere[vertex],
                t, f, k, area);
      }
}

/// A vertex of a facet that takes a force, as one number.
int corner_number(int facet, int k) { return 3 * facet + k; }

/// Rows first ... last - 1 of S, made one after the other from the corners that act on each.
class RowMaker {
 public:
  RowMaker(const PoreNetwork& network, const Throats& throats, const ViscousShares& shares,
           ForceParts parts, const std::vector<int>& throat_of_facet)
      : network_(network), throats_(throats), shares_(shares), parts_(parts),
        throat_of_facet_(throat_of_facet), place_(network.pores(), -1) {}

  /// Appends a row: its entries by ascending pores, those of one pore added in the order of the corners.
  void add(const int* begin, const int* end) {
    row_.clear();
    for (const int* corner = begin; corner != end; ++corner) {
      const int f = *corner / 3, k = *corner % 3, t = throat_of_facet_[f];
      const Eigen::Vector3d force =
          share_of_corner(throats_, shares_, parts_, t, f, k) * throats_.normal.col(t);
      take(network_.throat_pores[t][0], force);
      take(network_.throat_pores[t][1], -force);
    }
    std::sort(row_.begin(), row_.end(),
              [](const Entry& a, const Entry& b) { return a.pore < b.pore; });
    for (const Entry& entry : row_) {
      pore.push_back(entry.pore);
      value.push_back(entry.value);
      place_[entry.pore] = -1;
    }
    entries.push_back(static_cast<int>(row_.size()));
  }

  void reserve(std::size_t count) {
    pore.reserve(count);
    value.reserve(count);
  }

  std::vector<int> pore, entries;  ///< `entries`: of each row
  std::vector<Eigen::Vector3d> value;

 private:
  struct Entry {
    int pore;
    Eigen::Vector3d value;
  };

  void take(int p, const Eigen::Vector3d& force) {
    if (place_[p] < 0) {
      place_[p] = static_cast<int>(row_.size());
      row_.push_back({p, force});
    } else {
      row_[place_[p]].value += force;
    }
  }

  const PoreNetwork& network_;
  const Throats& throats_;
  const ViscousShares& shares_;
  ForceParts parts_;
  const std::vector<int>& throat_of_facet_;
  std::vector<Entry> row_;
  std::vector<int> place_;  ///< in the row, by pore
};

ForceMatrix joined(std::vector<RowMaker>& makers) {
  ForceMatrix matrix;
  std::size_t entries = 0;
  for (const RowMaker& maker : makers) {
    entries += maker.pore.size();
    for (const int count : maker.entries)
      matrix.row_begin.push_back(matrix.row_begin.back() + count);
  }
  matrix.pore.reserve(entries);
  matrix.value.resize(3, static_cast<Eigen::Index>(entries));
  Eigen::Index column = 0;
  for (RowMaker& maker : makers) {
    matrix.pore.insert(matrix.pore.end(), maker.pore.begin(), maker.pore.end());
    for (const Eigen::Vector3d& value : maker.value) matrix.value.col(column++) = value;
    maker.pore = {};
    maker.value = {};
  }
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
                         const ViscousShares& shares, int spheres, ForceParts parts, Team& team) {
  const int rows = spheres + 6;
  std::vector<int> begin(rows + 1, 0), throat_of_facet(network.throat_facets.back());
  for_each_share(network, throats, shares, spheres, parts,
                 [&](int row, int, int, int, double) { ++begin[row + 1]; });
  for (int row = 0; row < rows; ++row) begin[row + 1] += begin[row];
  std::vector<int> next(begin.begin(), begin.end() - 1), corners(begin.back());
  for_each_share(network, throats, shares, spheres, parts,
                 [&](int row, int t, int f, int k, double) {
                   corners[next[row]++] = corner_number(f, k);
                   throat_of_facet[f] = t;
                 });
  const int pieces = team.threads();
  std::vector<RowMaker> makers(pieces, {network, throats, shares, parts, throat_of_facet});
  for (RowMaker& maker : makers)  // a sphere meets a pore in each cell that has it for a vertex
    maker.reserve(4 * static_cast<std::size_t>(network.cells()) / pieces + 64);
  team.run(pieces, [&](int piece) {
    const auto bound = [&](int number) {
      return static_cast<int>(static_cast<std::int64_t>(rows) * number / pieces);
    };
    for (int row = bound(piece); row < bound(piece + 1); ++row)
      makers[piece].add(corners.data() + begin[row], corners.data() + begin[row + 1]);
  });
  return joined(makers);
}

ForceMatrix force_matrix(const PoreNetwork& network, const Throats& throats,
                         const ViscousShares& shares, int spheres, ForceParts parts) {
  Team alone;
  return force_matrix(network, throats, shares, spheres, parts, alone);
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
  for_each_share(network, throats, shares, spheres, parts, [&](int row, int t, int, int, double area) {
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
