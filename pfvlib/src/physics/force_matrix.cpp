// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/force_matrix.hpp"

#include "geometry/solid_angle.hpp"
#include "network/facets.hpp"
#include "physics/disc_parts.hpp"

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

/// What S is made of.
struct Makings {
  const PoreNetwork& network;
  const Spheres& vertices;
  const Throats& throats;
  const ViscousShares& shares;
  int spheres;
  ForceParts parts;

  /// The part of throat t's area that acts on corner k of its facet f.
  double area(int t, int f, int k) const {
    double sum = 0.0;
    if (parts.pressure) sum += throats.facet_disc[f][k];
    if (parts.viscous) sum += throats.fluid_area[t] * shares[f][k];
    return sum;
  }
  int row(int f, int k) const {
    const Vertex vertex = network.facet_vertices[f][k];
    return is_wall(vertex) ? spheres + wall_number(vertex) : network.vertex_sphere[vertex];
  }
  /// Calls visit(throat, facet, corner) for every facet vertex that takes a force.
  template <class Visit>
  void for_each_corner(Visit&& visit) const {
    for (int t = 0; t < network.throats(); ++t)
      for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
        for (int k = 0; k < 3; ++k)
          if (area(t, f, k) != 0.0) visit(t, f, k);
  }
};

Eigen::Vector3d moment_of_disc(const Makings& m, int f, int k) {
  const auto& facet = m.network.facet_vertices[f];
  if (is_wall(facet[k])) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d area = area_vector(facet, m.vertices);
  const double size = area.norm();
  if (size == 0.0) return Eigen::Vector3d::Zero();
  return disc_moment(facet, k, m.vertices, area / size, size);
}

/// Moment about the corner of the box of a unit pressure on a throat's fluid area: that on its facets less
/// that on the discs, m³.
Eigen::Vector3d moment_of_fluid(const Makings& m, int t) {
  const Eigen::Vector3d normal = m.throats.normal.col(t);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), discs = sum;
  for (int f = m.network.throat_facets[t]; f < m.network.throat_facets[t + 1]; ++f) {
    sum += moment_vector(corners_of(m.network.facet_vertices[f], m.vertices));
    for (int k = 0; k < 3; ++k) {
      const double part = m.throats.facet_disc[f][k];
      if (part == 0.0) continue;
      discs += part * m.vertices.centres.col(m.network.facet_vertices[f][k]) + moment_of_disc(m, f, k);
    }
  }
  return sum - discs.cross(normal);
}

/// What each corner of each facet takes of a unit pressure difference across its throat.
///
/// A sphere's share of the viscous force acts towards the centroid of the fluid area, but no farther from its
/// own centre than its surface: at the centroid, small spheres beside a wide throat would be spun by levers
/// many times their radius. The couple that is left, so that all moments together are those of a pressure on
/// the fluid area, goes to the spheres of the throat by share and radius, those that it turns least.
class Corners {
 public:
  Corners(const Makings& makings, Team& team) : m_(makings) {
    if (!m_.parts.moments) return;
    fluid_.resize(3, m_.network.throats());
    couple_.setZero(3, m_.parts.viscous ? m_.network.throats() : 0);
    constexpr int piece = 512;
    team.run((m_.network.throats() + piece - 1) / piece, [&](int number) {
      const int last = std::min((number + 1) * piece, m_.network.throats());
      for (int t = number * piece; t < last; ++t) {
        fluid_.col(t) = moment_of_fluid(m_, t);
        if (m_.parts.viscous) couple_.col(t) = couple(t);
      }
    });
  }

  Vector6d operator()(int t, int f, int k) const {
    const Eigen::Vector3d normal = m_.throats.normal.col(t);
    Vector6d load;
    load.head<3>() = m_.area(t, f, k) * normal;
    load.tail<3>().setZero();
    if (m_.parts.moments) load.tail<3>() = moment(t, f, k, normal);
    return load;
  }

 private:
  Vertex vertex(int f, int k) const { return m_.network.facet_vertices[f][k]; }

  /// Of a share that acts at the centroid of the fluid area, about the sphere's centre.
  Eigen::Vector3d at_centroid(int t, int f, int k) const {
    return m_.shares[f][k] * (fluid_.col(t) - m_.throats.fluid_area[t] *
                                                  m_.vertices.centres.col(vertex(f, k))
                                                      .cross(m_.throats.normal.col(t)));
  }

  /// Part of the way to the centroid at which the sphere's surface lies, at most 1.
  double reach(int t, int f, int k, const Eigen::Vector3d& moment) const {
    const double lever = moment.norm();
    const double most = std::abs(m_.shares[f][k]) * m_.throats.fluid_area[t] *
                        m_.vertices.radii[vertex(f, k)];
    return lever > most ? most / lever : 1.0;
  }

  double weight(int f, int k) const {
    return is_wall(vertex(f, k))
               ? 0.0
               : std::max(m_.shares[f][k], 0.0) * m_.vertices.radii[vertex(f, k)];
  }

  /// What is left to the spheres of throat t, over the sum of their weights.
  Eigen::Vector3d couple(int t) const {
    Eigen::Vector3d left = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (int f = m_.network.throat_facets[t]; f < m_.network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        if (is_wall(vertex(f, k))) continue;
        const Eigen::Vector3d full = at_centroid(t, f, k);
        left += (1.0 - reach(t, f, k, full)) * full;
        weights += weight(f, k);
      }
    return weights > 0.0 ? Eigen::Vector3d(left / weights) : Eigen::Vector3d::Zero();
  }

  Eigen::Vector3d moment(int t, int f, int k, const Eigen::Vector3d& normal) const {
    if (is_wall(vertex(f, k)))
      return m_.parts.viscous ? Eigen::Vector3d(m_.shares[f][k] * fluid_.col(t))
                              : Eigen::Vector3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (m_.parts.viscous) {
      const Eigen::Vector3d full = at_centroid(t, f, k);
      sum = reach(t, f, k, full) * full + weight(f, k) * couple_.col(t);
    }
    if (m_.parts.pressure && m_.throats.facet_disc[f][k] != 0.0)
      sum += moment_of_disc(m_, f, k).cross(normal);
    return sum;
  }

  const Makings& m_;
  Eigen::Matrix3Xd fluid_;   ///< `moment_of_fluid` of each throat
  Eigen::Matrix3Xd couple_;  ///< `couple` of each throat
};

/// A vertex of a facet that takes a force, as one number.
int corner_number(int facet, int k) { return 3 * facet + k; }

/// The corners that act on each row, and the throats of the facets.
struct CornerLists {
  std::vector<int> begin, corner, throat_of_facet;

  explicit CornerLists(const Makings& m)
      : begin(m.spheres + 7, 0), throat_of_facet(m.network.throat_facets.back()) {
    m.for_each_corner([&](int, int f, int k) { ++begin[m.row(f, k) + 1]; });
    for (std::size_t row = 1; row < begin.size(); ++row) begin[row] += begin[row - 1];
    std::vector<int> next(begin.begin(), begin.end() - 1);
    corner.resize(begin.back());
    m.for_each_corner([&](int t, int f, int k) {
      corner[next[m.row(f, k)]++] = corner_number(f, k);
      throat_of_facet[f] = t;
    });
  }
};

/// The pores of one row of S after the other, ascending.
class RowPores {
 public:
  RowPores(const PoreNetwork& network, const CornerLists& lists)
      : network_(network), lists_(lists), row_of_(network.pores(), -1) {}

  const std::vector<int>& of(int row) {
    pores_.clear();
    for (int c = lists_.begin[row]; c < lists_.begin[row + 1]; ++c)
      for (const int pore : network_.throat_pores[lists_.throat_of_facet[lists_.corner[c] / 3]])
        if (row_of_[pore] != row) {
          row_of_[pore] = row;
          pores_.push_back(pore);
        }
    std::sort(pores_.begin(), pores_.end());
    return pores_;
  }

 private:
  const PoreNetwork& network_;
  const CornerLists& lists_;
  std::vector<int> row_of_, pores_;
};

/// Calls work(first row, one past the last) on a piece of the rows for each thread.
template <class Work>
void run_pieces(Team& team, int rows, const Work& work) {
  const int pieces = team.threads();
  const auto bound = [&](int number) {
    return static_cast<int>(static_cast<std::int64_t>(rows) * number / pieces);
  };
  team.run(pieces, [&](int piece) { work(bound(piece), bound(piece + 1)); });
}

/// Entries of one row, those of one pore added in the order of the corners.
void fill_row(ForceMatrix& matrix, const Makings& m, const CornerLists& lists,
              const Corners& corners, int row, std::vector<int>& place) {
  for (int e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e) {
    place[matrix.pore[e]] = e;
    matrix.value.col(e).setZero();
  }
  for (int c = lists.begin[row]; c < lists.begin[row + 1]; ++c) {
    const int f = lists.corner[c] / 3, t = lists.throat_of_facet[f];
    const Vector6d load = corners(t, f, lists.corner[c] % 3);
    matrix.value.col(place[m.network.throat_pores[t][0]]) += load;
    matrix.value.col(place[m.network.throat_pores[t][1]]) -= load;
  }
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

ForceMatrix force_matrix(const PoreNetwork& network, const Spheres& vertices,
                         const Throats& throats, const ViscousShares& shares, int spheres,
                         ForceParts parts, Team& team) {
  const Makings makings{network, vertices, throats, shares, spheres, parts};
  const CornerLists lists(makings);
  const Corners corners(makings, team);
  const int rows = spheres + 6;
  ForceMatrix matrix;
  matrix.row_begin.assign(rows + 1, 0);
  run_pieces(team, rows, [&](int first, int last) {
    RowPores pores(network, lists);
    for (int row = first; row < last; ++row)
      matrix.row_begin[row + 1] = static_cast<int>(pores.of(row).size());
  });
  for (int row = 0; row < rows; ++row) matrix.row_begin[row + 1] += matrix.row_begin[row];
  matrix.pore.resize(matrix.row_begin.back());
  matrix.value.resize(6, matrix.row_begin.back());
  run_pieces(team, rows, [&](int first, int last) {
    RowPores pores(network, lists);
    std::vector<int> place(network.pores());
    for (int row = first; row < last; ++row) {
      const std::vector<int>& own = pores.of(row);
      std::copy(own.begin(), own.end(), matrix.pore.begin() + matrix.row_begin[row]);
      fill_row(matrix, makings, lists, corners, row, place);
    }
  });
  return matrix;
}

ForceMatrix force_matrix(const PoreNetwork& network, const Spheres& vertices,
                         const Throats& throats, const ViscousShares& shares, int spheres,
                         ForceParts parts) {
  Team alone;
  return force_matrix(network, vertices, throats, shares, spheres, parts, alone);
}

void multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures, Team& team, Loads& loads) {
  loads.resize(6, matrix.rows());
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, matrix.rows(), [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      Vector6d sum = Vector6d::Zero();
      for (int e = begin[row]; e < begin[row + 1]; ++e)
        sum += pressures[matrix.pore[e]] * matrix.value.col(e);
      loads.col(row) = sum;
    }
  });
}

Loads multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures) {
  Team alone;
  Loads loads;
  multiply(matrix, pressures, alone, loads);
  return loads;
}

Loads gradient_forces(const PoreNetwork& network, const Spheres& vertices, const Throats& throats,
                      const ViscousShares& shares, int spheres, ForceParts parts,
                      const Eigen::Vector3d& gradient) {
  const Makings makings{network, vertices, throats, shares, spheres, parts};
  Team alone;
  const Corners corners(makings, alone);
  Loads loads = Loads::Zero(6, spheres + 6);
  makings.for_each_corner([&](int t, int f, int k) {
    loads.col(makings.row(f, k)) -= gradient.dot(network.throat_offset(t)) * corners(t, f, k);
  });
  return loads;
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
