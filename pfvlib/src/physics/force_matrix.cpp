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

  int rows() const { return spheres + vertices.wall_count(); }
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

/// What each corner of each facet of one throat takes of a unit pressure difference across it.
///
/// A sphere's share of the viscous force acts towards the centroid of the fluid area, but no farther from its
/// own centre than its surface: at the centroid, small spheres beside a wide throat would be spun by levers
/// many times their radius. The couple that is left, so that all moments together are those of a pressure on
/// the fluid area, goes to the spheres of the throat by share and radius, those that it turns least.
class ThroatLoads {
 public:
  explicit ThroatLoads(const Makings& makings) : m_(makings) {}

  /// Loads of the corners of throat t, facet by facet, into `loads`.
  void operator()(int t, Vector6d* loads) {
    t_ = t;
    first_ = m_.network.throat_facets[t];
    last_ = m_.network.throat_facets[t + 1];
    const Eigen::Vector3d normal = m_.throats.normal.col(t);
    const bool rubs_on_wall = m_.parts.wall_moments && m_.parts.viscous && has_rubbing_wall();
    if (m_.parts.moments || rubs_on_wall) measure(normal);
    if (m_.parts.moments && m_.parts.viscous) find_couple(normal);
    for (int f = first_; f < last_; ++f)
      for (int k = 0; k < 3; ++k) {
        Vector6d& load = loads[3 * (f - first_) + k];
        load.head<3>() = m_.area(t, f, k) * normal;
        if (m_.parts.moments || (rubs_on_wall && is_wall(vertex(f, k))))
          load.tail<3>() = moment(f, k, normal);
        else
          load.tail<3>().setZero();
      }
  }

 private:
  Vertex vertex(int f, int k) const { return m_.network.facet_vertices[f][k]; }
  auto centre(int f, int k) const { return m_.vertices.centres.col(vertex(f, k)); }

  bool has_rubbing_wall() const {
    for (int f = first_; f < last_; ++f)
      for (int k = 1; k < 3; ++k)
        if (is_wall(vertex(f, k)) && m_.shares[f][k] != 0.0) return true;
    return false;
  }

  /// First moments of the discs, and the moment about the corner of the box of a unit pressure on the fluid
  /// area: that on the facets less that on the discs.
  void measure(const Eigen::Vector3d& normal) {
    discs_.resize(3 * (last_ - first_));
    Eigen::Vector3d facets = Eigen::Vector3d::Zero(), discs = facets;
    for (int f = first_; f < last_; ++f) {
      const auto& facet = m_.network.facet_vertices[f];
      const Eigen::Vector3d area = area_vector(facet, m_.vertices);
      const double size = area.norm();
      facets += is_wall(facet[2]) ? moment_vector(corners_of(facet, m_.vertices))
                                  : Eigen::Vector3d((centre(f, 0) + centre(f, 1) + centre(f, 2))
                                                        .cross(area) / 3.0);
      for (int k = 0; k < 3; ++k) {
        Eigen::Vector3d& own = discs_[3 * (f - first_) + k];
        own.setZero();
        const double part = m_.throats.facet_disc[f][k];
        if (part == 0.0 || size == 0.0) continue;
        own = disc_moment(facet, k, m_.vertices, area / size, size);
        discs += part * centre(f, k) + own;
      }
    }
    fluid_ = facets - discs.cross(normal);
  }

  /// Of a share that acts at the centroid of the fluid area, about the sphere's centre; `reach`: the part of
  /// the way to there at which the sphere's surface lies, at most 1.
  Eigen::Vector3d at_centroid(int f, int k, const Eigen::Vector3d& normal, double& reach) const {
    const double share = m_.shares[f][k], area = m_.throats.fluid_area[t_];
    const Eigen::Vector3d full = share * (fluid_ - area * centre(f, k).cross(normal));
    const double lever = full.norm();
    const double most = std::abs(share) * area * m_.vertices.radii[vertex(f, k)];
    reach = lever > most ? most / lever : 1.0;
    return full;
  }
  double weight(int f, int k) const {
    return std::max(m_.shares[f][k], 0.0) * m_.vertices.radii[vertex(f, k)];
  }

  /// What is left to the spheres, over the sum of their weights.
  void find_couple(const Eigen::Vector3d& normal) {
    couple_.setZero();
    double weights = 0.0, reach = 1.0;
    for (int f = first_; f < last_; ++f)
      for (int k = 0; k < 3; ++k) {
        if (is_wall(vertex(f, k))) continue;
        const Eigen::Vector3d full = at_centroid(f, k, normal, reach);
        couple_ += (1.0 - reach) * full;
        weights += weight(f, k);
      }
    if (weights > 0.0) couple_ /= weights;
    else couple_.setZero();
  }

  Eigen::Vector3d moment(int f, int k, const Eigen::Vector3d& normal) const {
    if (is_wall(vertex(f, k)))
      return m_.parts.viscous ? Eigen::Vector3d(m_.shares[f][k] * fluid_)
                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (m_.parts.viscous) {
      double reach = 1.0;
      const Eigen::Vector3d full = at_centroid(f, k, normal, reach);
      sum = reach * full + weight(f, k) * couple_;
    }
    if (m_.parts.pressure) sum += discs_[3 * (f - first_) + k].cross(normal);
    return sum;
  }

  const Makings& m_;
  int t_ = 0, first_ = 0, last_ = 0;
  std::vector<Eigen::Vector3d> discs_;
  Eigen::Vector3d fluid_, couple_;
};

/// A vertex of a facet that takes a force, as one number.
int corner_number(int facet, int k) { return 3 * facet + k; }

/// The corners that act on each row, and the throats of the facets.
struct CornerLists {
  std::vector<int> begin, corner, throat_of_facet;

  explicit CornerLists(const Makings& m)
      : begin(m.rows() + 1, 0), throat_of_facet(m.network.throat_facets.back()) {
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

/// The pattern of S: each row's pores, ascending.
void find_pattern(ForceMatrix& matrix, const Makings& m, Team& team) {
  const CornerLists lists(m);
  const int rows = m.rows(), pieces = team.threads();
  const auto bound = [&](int number) {
    return static_cast<int>(static_cast<std::int64_t>(rows) * number / pieces);
  };
  std::vector<std::vector<int>> found(pieces);
  matrix.row_begin.assign(rows + 1, 0);
  team.run(pieces, [&](int piece) {
    RowPores pores(m.network, lists);
    found[piece].reserve(4 * static_cast<std::size_t>(m.network.cells()) / pieces + 64);
    for (int row = bound(piece); row < bound(piece + 1); ++row) {
      const std::vector<int>& own = pores.of(row);
      matrix.row_begin[row + 1] = static_cast<int>(own.size());
      found[piece].insert(found[piece].end(), own.begin(), own.end());
    }
  });
  for (int row = 0; row < rows; ++row) matrix.row_begin[row + 1] += matrix.row_begin[row];
  matrix.pore.reserve(matrix.row_begin.back());
  for (std::vector<int>& piece : found) {
    matrix.pore.insert(matrix.pore.end(), piece.begin(), piece.end());
    piece = {};
  }
}

/// Adds the loads of throats first ... last - 1, whose corners are in `loads`, to their entries.
void add_throats(ForceMatrix& matrix, const Makings& m, int first, int last, const Vector6d* loads) {
  const auto entry = [&](int row, int pore) {
    const auto begin = matrix.pore.begin() + matrix.row_begin[row];
    const auto end = matrix.pore.begin() + matrix.row_begin[row + 1];
    return std::lower_bound(begin, end, pore) - matrix.pore.begin();
  };
  const int first_facet = m.network.throat_facets[first];
  for (int t = first; t < last; ++t)
    for (int f = m.network.throat_facets[t]; f < m.network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        if (m.area(t, f, k) == 0.0) continue;
        const Vector6d& load = loads[3 * (f - first_facet) + k];
        const int row = m.row(f, k);
        matrix.value.col(entry(row, m.network.throat_pores[t][0])) += load;
        matrix.value.col(entry(row, m.network.throat_pores[t][1])) -= load;
      }
}

/// Throats that a thread takes at a time, and those whose loads are kept until they are added, in order.
constexpr int piece_size = 512, round_size = 16 * piece_size;

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
  ForceMatrix matrix;
  matrix.spheres = spheres;
  matrix.wall_moments = parts.wall_moments || parts.moments;
  find_pattern(matrix, makings, team);
  matrix.value.setZero(6, matrix.row_begin.back());
  std::vector<Vector6d> loads;
  for (int first = 0; first < network.throats(); first += round_size) {
    const int last = std::min(first + round_size, network.throats());
    const int first_facet = network.throat_facets[first];
    loads.resize(3 * (network.throat_facets[last] - first_facet));
    team.run((last - first + piece_size - 1) / piece_size, [&](int piece) {
      ThroatLoads loads_of_throat(makings);
      const int begin = first + piece * piece_size, end = std::min(begin + piece_size, last);
      for (int t = begin; t < end; ++t)
        loads_of_throat(t, &loads[3 * (network.throat_facets[t] - first_facet)]);
    });
    add_throats(matrix, makings, first, last, loads.data());
  }
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
                      const Eigen::Vector3d& gradient, const Share& share) {
  const Makings makings{network, vertices, throats, shares, spheres, parts};
  Loads loads = no_motion(spheres, vertices.wall_count());
  ThroatLoads loads_of_throat(makings);
  std::vector<Vector6d> own;
  for (int t = 0; t < network.throats(); ++t) {
    const double drop = -gradient.dot(network.throat_offset(t));
    if (drop == 0.0) continue;
    const int first = network.throat_facets[t];
    own.resize(3 * (network.throat_facets[t + 1] - first));
    loads_of_throat(t, own.data());
    for (int f = first; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k)
        if (makings.area(t, f, k) != 0.0 &&
            (makings.row(f, k) < spheres || share.owns_pore(network.throat_pores[t][0])))
          loads.col(makings.row(f, k)) += drop * own[3 * (f - first) + k];
  }
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
