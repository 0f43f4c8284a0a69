// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/open_water.hpp"

#include "geometry/pi.hpp"
#include "physics/bead_mobility.hpp"
#include "physics/isotropic_drag.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace pfv {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double nearest = 1.5;        // radii: nearer, roughness and contacts decide
constexpr double haberman = 2.1044;    // of r/R on the axis of a tube: Happel & Brenner, eq. 7-3.27
constexpr double least_mobility = 0.2, most_mobility = 1.6;
constexpr double negligible = 1e-6;  // of Stokes' drag

/// The throats around each pore.
struct ThroatLists {
  std::vector<int> begin, throat;

  explicit ThroatLists(const PoreNetwork& network) : begin(network.pores() + 1, 0), throat(2 * network.throats()) {
    for (const auto& pores : network.throat_pores)
      for (const int pore : pores) ++begin[pore + 1];
    for (int p = 0; p < network.pores(); ++p) begin[p + 1] += begin[p];
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (int t = 0; t < network.throats(); ++t)
      for (const int pore : network.throat_pores[t]) throat[next[pore]++] = t;
  }
};

/// S_k G_k^-1 S_k^T of the pores around sphere k, kg/s. The pores around them hold their pressure, by which it is no
/// larger than the whole network's.
Matrix3d drag_of_pores(const PoreNetwork& network, const Conductances& conductances, const ForceMatrix& matrix,
                       const std::vector<char>& imposed, const ThroatLists& lists, int k) {
  const int begin = matrix.row_begin[k], end = matrix.row_begin[k + 1];
  std::map<int, int> place;  // among the unknown ones; -1: imposed
  int count = 0;
  for (int e = begin; e < end; ++e) place[matrix.pore[e]] = imposed[matrix.pore[e]] ? -1 : count++;
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixX3d s = Eigen::MatrixX3d::Zero(count, 3);
  for (int e = begin; e < end; ++e)
    if (const int i = place[matrix.pore[e]]; i >= 0) s.row(i) = matrix.value.col(e).head<3>();
  for (const auto& [pore, i] : place) {
    if (i < 0) continue;
    for (int l = lists.begin[pore]; l < lists.begin[pore + 1]; ++l) {
      const int t = lists.throat[l];
      const auto& [first, second] = network.throat_pores[t];
      const auto other = place.find(first == pore ? second : first);
      g(i, i) += conductances.value[t];
      if (other != place.end() && other->second >= 0) g(i, other->second) -= conductances.value[t];
    }
  }
  if (count == 0) return Matrix3d::Zero();
  // a set without an imposed pressure is free to shift: the sources of a sphere add up to 0 in it
  g.diagonal().array() += 1e-10 * g.diagonal().maxCoeff();
  const Matrix3d drag = s.transpose() * g.ldlt().solve(s);
  return 0.5 * (drag + drag.transpose());
}

PlaneKind kind_of(const ContainerFace& face) {
  if (face.boundary.imposes_pressure()) return PlaneKind::open;
  return face.wall == Wall::no_slip ? PlaneKind::no_slip : PlaneKind::slip;
}

bool is_periodic(const Container& container, int face) {
  return face < 6 && container.any_periodic() && container.periodic[face / 2];
}

/// By how much a wall changes the mobility of sphere k, over that in unbounded fluid.
Matrix3d change_at_wall(const Spheres& spheres, int k, int wall, PlaneKind kind) {
  const Vector3d n = spheres.outward(k, wall_vertex(wall));
  const auto [along, towards] = mobility_beside_plane(kind, spheres.radii[k], spheres.distance(k, wall));
  const Matrix3d across = n * n.transpose();
  Matrix3d change = (towards - 1.0) * across + (along - 1.0) * (Matrix3d::Identity() - across);
  const WallSurface& surface = spheres.walls[wall];
  if (surface.is_plane() || kind != PlaneKind::no_slip) return change;
  const double around = -haberman * spheres.radii[k] / surface.surface.radius;
  change.diagonal() = change.diagonal().cwiseMin(around);
  return change;
}

/// W: drag beside the walls over that in unbounded fluid.
Matrix3d wall_correction(const Container& container, const Spheres& spheres, int k) {
  Matrix3d mobility = Matrix3d::Identity(), nearest_free = Matrix3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int wall = 0; wall < spheres.wall_count(); ++wall) {
    if (is_periodic(container, wall)) continue;
    const PlaneKind kind = kind_of(container.faces[wall]);
    const Matrix3d change = change_at_wall(spheres, k, wall, kind);
    if (kind == PlaneKind::no_slip) {
      mobility += change;
    } else if (const double distance = spheres.distance(k, wall); distance < least) {
      least = distance;
      nearest_free = change;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(Matrix3d(mobility + nearest_free));
  const Vector3d bounded = parts.eigenvalues().cwiseMax(least_mobility).cwiseMin(most_mobility);
  return parts.eigenvectors() * bounded.cwiseInverse().asDiagonal() * parts.eigenvectors().transpose();
}

/// Drag in unbounded fluid over 6 pi mu, m, of the spheres in open water that a body holds.
std::map<int, Matrix3d> drags_in_bodies(const Spheres& spheres, const std::vector<int>& body, const std::vector<int>& open) {
  std::map<int, std::vector<int>> members;
  for (const int k : open)
    if (!body.empty() && body[k] >= 0) members[body[k]];
  for (int k = 0; k < static_cast<int>(body.size()); ++k)
    if (const auto found = members.find(body[k]); found != members.end()) found->second.push_back(k);
  std::map<int, Matrix3d> drags;
  for (const auto& [number, beads] : members) {
    const std::vector<Matrix3d> of_beads = drags_of_beads(spheres, beads);
    for (std::size_t i = 0; i < beads.size(); ++i) drags[beads[i]] = of_beads[i];
  }
  return drags;
}

Matrix3d positive_part(const Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(matrix);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() * parts.eigenvectors().transpose();
}

/// What the surfaces of the spheres in question look at.
class Surroundings {
 public:
  Surroundings(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices,
               const Container& container, const std::vector<int>& body)
      : network_(network), spheres_(spheres), vertices_(vertices), container_(container), body_(body) {}

  void look(const Throats& throats, std::vector<OpenWaterDrag>& drags) {
    std::vector<int> place(spheres_.size(), -1);
    for (std::size_t i = 0; i < drags.size(); ++i) place[drags[i].sphere] = static_cast<int>(i);
    views_.assign(drags.size(), View(spheres_.wall_count()));
    for (int f = 0; f < network_.throat_facets.back(); ++f)
      for (int c = 0; c < 3; ++c) {
        const Vertex own = network_.facet_vertices[f][c];
        if (is_wall(own)) continue;
        if (const int i = place[network_.vertex_sphere[own]]; i >= 0)
          for (int d = 0; d < 3; ++d)
            if (d != c) see(views_[i], own, network_.facet_vertices[f][d], throats.facet_gamma[f][c]);
      }
    for (std::size_t i = 0; i < drags.size(); ++i) fill(views_[i], drags[i]);
  }

 private:
  struct View {
    explicit View(int walls) : of_wall(walls, 0.0) {}
    std::map<Packing::Ids::Scalar, std::pair<int, double>> of_sphere;  ///< by id
    std::vector<double> of_wall;
    Vector3d periods = Vector3d::Zero();
    double all = 0.0;
  };

  void see(View& view, Vertex own, Vertex other, double area) const {
    const double weight = std::max(area, 0.0);
    if (is_wall(other)) {
      view.of_wall[wall_number(other)] += weight;
    } else if (const int sphere = network_.vertex_sphere[other]; !move_together(network_.vertex_sphere[own], sphere)) {
      auto& [column, seen] = view.of_sphere[spheres_.ids[sphere]];
      column = sphere;
      seen += weight;
      view.periods += weight * (periods_of(other) - periods_of(own));
    } else {
      return;
    }
    view.all += weight;
  }

  bool move_together(int one, int other) const {
    return one == other || (!body_.empty() && body_[one] >= 0 && body_[one] == body_[other]);
  }

  Vector3d periods_of(Vertex vertex) const {
    Vector3d periods = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (spheres_.periodic[axis])
        periods[axis] = std::round((vertices_.centres(axis, vertex) -
                                    spheres_.centres(axis, network_.vertex_sphere[vertex])) / spheres_.edges[axis]);
    return periods;
  }

  /// What a face carries the water along by: all of its velocity, a slip wall only across.
  Matrix3d carried_by(int face, int k) const {
    if (kind_of(container_.faces[face]) != PlaneKind::slip) return Matrix3d::Identity();
    const Vector3d n = spheres_.outward(k, wall_vertex(face));
    return n * n.transpose();
  }

  /// The velocity of the faces around is the one that fits those of each best: weights (sum N)^-1 N_f.
  void fill(const View& view, OpenWaterDrag& drag) const {
    if (!(view.all > 0.0)) return;
    drag.periods = view.periods / view.all;
    for (const auto& [id, seen] : view.of_sphere) drag.neighbours.push_back({seen.first, seen.second / view.all});
    double of_walls = 0.0;
    Matrix3d sum = Matrix3d::Zero();
    for (int f = 0; f < spheres_.wall_count(); ++f) {
      if (!(view.of_wall[f] > 0.0) || is_periodic(container_, f)) continue;
      of_walls += view.of_wall[f] / view.all;
      sum += view.of_wall[f] * carried_by(f, drag.sphere);
    }
    if (!(of_walls > 0.0)) return;
    const Matrix3d inverse = pseudo_inverse(sum);
    for (int f = 0; f < spheres_.wall_count(); ++f)
      if (view.of_wall[f] > 0.0 && !is_periodic(container_, f))
        drag.faces.push_back({spheres_.size() + f, of_walls * view.of_wall[f] * inverse * carried_by(f, drag.sphere),
                              spheres_.centres.col(drag.sphere) + spheres_.distance(drag.sphere, f) *
                                                                      spheres_.outward(drag.sphere, wall_vertex(f))});
  }

  static Matrix3d pseudo_inverse(const Matrix3d& matrix) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(matrix);
    const double least = 1e-6 * parts.eigenvalues().cwiseAbs().maxCoeff();
    const Vector3d inverse =
        parts.eigenvalues().unaryExpr([=](double value) { return value > least ? 1.0 / value : 0.0; });
    return parts.eigenvectors() * inverse.asDiagonal() * parts.eigenvectors().transpose();
  }

  const PoreNetwork& network_;
  const Spheres &spheres_, &vertices_;
  const Container& container_;
  const std::vector<int>& body_;
  std::vector<View> views_;
};

/// What a drag makes of the velocity of each sphere: of its own the part that anything around resists.
std::vector<std::pair<int, Matrix3d>> weights_of(const OpenWaterDrag& drag) {
  Matrix3d own = Matrix3d::Zero();
  std::vector<std::pair<int, Matrix3d>> weights;
  for (const auto& [sphere, weight] : drag.neighbours) {
    weights.push_back({sphere, -weight * Matrix3d::Identity()});
    own += weight * Matrix3d::Identity();
  }
  for (const auto& face : drag.faces) own += face.weight;
  weights.push_back({drag.sphere, own});
  return weights;
}

}  // namespace

WallMobility mobility_beside_plane(PlaneKind kind, double radius, double distance) {
  const double q = 1.0 / std::max(distance / radius, nearest);
  switch (kind) {
    case PlaneKind::no_slip: {
      const double gap = 1.0 / q - 1.0;
      return {1.0 - 9.0 / 16.0 * q + std::pow(q, 3) / 8.0 - 45.0 / 256.0 * std::pow(q, 4) - std::pow(q, 5) / 16.0,
              (6.0 * gap * gap + 2.0 * gap) / (6.0 * gap * gap + 9.0 * gap + 2.0)};
    }
    case PlaneKind::slip: return {1.0 + 3.0 / 8.0 * q, 1.0 - 3.0 / 4.0 * q};
    case PlaneKind::open: return {1.0 - 3.0 / 8.0 * q, 1.0 + 3.0 / 4.0 * q};
  }
  return {};
}

std::vector<OpenWaterDrag> open_water_drags(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices,
                                            const Throats& throats, const Conductances& conductances,
                                            const ForceMatrix& matrix, const std::vector<char>& imposed,
                                            const Container& container, double viscosity,
                                            const std::vector<ResistanceBlock>& others, const std::vector<int>& body) {
  const std::vector<double> fractions = solid_fractions_around(network, throats, vertices);
  std::vector<int> open;
  for (int k = 0; k < static_cast<int>(fractions.size()); ++k)
    if (fractions[k] < open_fraction) open.push_back(k);
  std::vector<OpenWaterDrag> drags;
  if (open.empty()) return drags;
  std::sort(open.begin(), open.end(), [&](int a, int b) { return spheres.ids[a] < spheres.ids[b]; });
  const ThroatLists lists(network);
  const std::map<int, Matrix3d> in_bodies = drags_in_bodies(spheres, body, open);
  const auto unbounded = [&](int k) {
    const auto found = in_bodies.find(k);
    return found == in_bodies.end() ? Matrix3d(spheres.radii[k] * Matrix3d::Identity()) : found->second;
  };
  std::vector<Matrix3d> known(spheres.size(), Matrix3d::Zero());
  for (const auto& [of, by, block] : others)
    if (of == by) known[of] += block;
  for (const int k : open) {
    const double stokes = 6.0 * pi * viscosity * spheres.radii[k];
    const Matrix3d walls = wall_correction(container, spheres, k), free = unbounded(k);
    const Matrix3d left_out = positive_part(3.0 * pi * viscosity * (walls * free + free * walls) -
                                            drag_of_pores(network, conductances, matrix, imposed, lists, k) - known[k]);
    if (left_out.diagonal().maxCoeff() > negligible * stokes) drags.push_back({k, left_out, {}, Vector3d::Zero(), {}});
  }
  Surroundings(network, spheres, vertices, container, body).look(throats, drags);
  return drags;
}

Vector3d velocity_past(const OpenWaterDrag& drag, const Motion& motion, const Matrix3d& of_periods) {
  const Vector3d own = motion.col(drag.sphere).head<3>();
  Vector3d past = -of_periods * drag.periods;
  for (const auto& [sphere, weight] : drag.neighbours) past += weight * (own - motion.col(sphere).head<3>());
  for (const auto& [column, weight, at] : drag.faces)
    past += weight * (own - motion.col(column).head<3>() - motion.col(column).tail<3>().cross(at));
  return past;
}

void add_blocks(const std::vector<OpenWaterDrag>& drags, std::vector<ResistanceBlock>& blocks) {
  for (const OpenWaterDrag& drag : drags) {
    const auto weights = weights_of(drag);
    for (const auto& [of, left] : weights)
      for (const auto& [by, right] : weights)
        blocks.push_back({of, by, left.transpose() * drag.resistance * right});
  }
}

void add_open_water_forces(const std::vector<OpenWaterDrag>& drags, const Motion& motion, const Matrix3d& of_periods,
                           Loads& loads) {
  for (const OpenWaterDrag& drag : drags) {
    const Vector3d force = drag.resistance * velocity_past(drag, motion, of_periods);
    auto own = loads.col(drag.sphere).head<3>();
    for (const auto& [sphere, weight] : drag.neighbours) {
      own -= weight * force;
      loads.col(sphere).head<3>() += weight * force;
    }
    for (const auto& [column, weight, at] : drag.faces) {
      const Vector3d reaction = weight.transpose() * force;
      own -= reaction;
      loads.col(column).head<3>() += reaction;
      loads.col(column).tail<3>() += at.cross(reaction);
    }
  }
}

}  // namespace pfv
