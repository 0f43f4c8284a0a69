// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/open_water.hpp"

#include "geometry/pi.hpp"
#include "network/periodic_images.hpp"
#include "network/pore_boundaries.hpp"
#include "physics/drag_of_bodies.hpp"
#include "physics/isotropic_drag.hpp"
#include "problem/container_geometry.hpp"

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

PlaneKind kind_of(const ContainerFace& face) {
  if (face.boundary.imposes_pressure()) return PlaneKind::open;
  return face.wall == Wall::no_slip ? PlaneKind::no_slip : PlaneKind::slip;
}

bool is_periodic(const Container& container, int face) { return periodic_axis(container, face) >= 0; }

/// By how much a wall changes the mobility of sphere k, over that in unbounded fluid.
Matrix3d change_at_wall(const Spheres& spheres, int k, int wall, PlaneKind kind) {
  const Vector3d n = spheres.outward(k, wall_vertex(wall));
  auto [along, towards] = mobility_beside_plane(kind, spheres.radii[k], spheres.distance(k, wall));
  const WallSurface& surface = spheres.walls[wall];
  if (!surface.is_plane() && kind == PlaneKind::no_slip) {
    const double around = 1.0 - haberman * spheres.radii[k] / surface.surface.radius;
    along = std::min(along, around);
    towards = std::min(towards, around);
  }
  const Matrix3d across = n * n.transpose();
  return (towards - 1.0) * across + (along - 1.0) * (Matrix3d::Identity() - across);
}

/// By how much other planes around sphere k stand in for plane `wall`: each corrects for all that lies in its direction,
/// so that the many sides of a prism would count a round wall many times over. Weights cos^1.5 / distance² leave sides at
/// right angles whole, and of flats around a tube what the tube has to first order in r/R: along it 2.02 r/R on
/// the axis for 2.10, 0.95 to 1.13 of it off the axis; across it 1 to 1.7 times as much (doc/open_water.md).
double share_of_plane(const Container& container, const Spheres& spheres, int k, int wall) {
  if (!spheres.walls[wall].is_plane()) return 1.0;
  const Vector3d own = spheres.walls[wall].surface.normal;
  const double distance = spheres.distance(k, wall);
  double planes = 0.0;
  for (int other = 0; other < spheres.wall_count(); ++other) {
    if (!spheres.walls[other].is_plane() || is_periodic(container, other)) continue;
    if (kind_of(container.faces[other]) != PlaneKind::no_slip) continue;
    const double cosine = own.dot(spheres.walls[other].surface.normal);
    if (!(cosine > 0.0)) continue;
    const double nearer = other == wall ? 1.0 : distance / std::max(spheres.distance(k, other), 1e-3 * distance);
    planes += cosine * std::sqrt(cosine) * nearer * nearer;
  }
  return 1.0 / planes;
}

Matrix3d positive_part(const Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(matrix);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() * parts.eigenvectors().transpose();
}

/// Beside all no-slip walls. Along no direction larger than beside one plane alone, since further walls only add to
/// the dissipation (Hill & Power 1956); walls at right angles keep that by themselves.
Matrix3d mobility_beside_walls(const Container& container, const Spheres& spheres, int k) {
  Matrix3d mobility = Matrix3d::Identity();
  std::vector<Matrix3d> alone;
  bool shared = false;
  for (int wall = 0; wall < spheres.wall_count(); ++wall) {
    if (is_periodic(container, wall) || kind_of(container.faces[wall]) != PlaneKind::no_slip) continue;
    const double share = share_of_plane(container, spheres, k, wall);
    const Matrix3d change = change_at_wall(spheres, k, wall, PlaneKind::no_slip);
    mobility += share * change;
    alone.push_back(Matrix3d::Identity() + change);
    shared = shared || share != 1.0;
  }
  if (shared)
    for (const Matrix3d& most : alone) mobility = most - positive_part(most - mobility);
  return mobility;
}

/// W: drag beside the walls over that in unbounded fluid.
Matrix3d wall_correction(const Container& container, const Spheres& spheres, int k) {
  Matrix3d nearest_free = Matrix3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int wall = 0; wall < spheres.wall_count(); ++wall) {
    if (is_periodic(container, wall)) continue;
    const PlaneKind kind = kind_of(container.faces[wall]);
    if (kind == PlaneKind::no_slip) continue;
    if (const double distance = spheres.distance(k, wall); distance < least) {
      least = distance;
      nearest_free = change_at_wall(spheres, k, wall, kind);
    }
  }
  const Matrix3d mobility = mobility_beside_walls(container, spheres, k) + nearest_free;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(mobility);
  const Vector3d bounded = parts.eigenvalues().cwiseMax(least_mobility).cwiseMin(most_mobility);
  return parts.eigenvectors() * bounded.cwiseInverse().asDiagonal() * parts.eigenvectors().transpose();
}

/// What the surfaces of the spheres in question look at.
class Surroundings {
 public:
  Surroundings(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices,
               const Container& container, const std::vector<int>& body, bool still)
      : network_(network), spheres_(spheres), vertices_(vertices), container_(container), body_(body),
        still_(still) {}

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
    double all = 0.0, of_small = 0.0;  ///< of_small: left to the faces
  };

  void see(View& view, Vertex own, Vertex other, double area) const {
    const double weight = std::max(area, 0.0);
    if (is_wall(other)) {
      view.of_wall[wall_number(other)] += weight;
    } else if (const int sphere = network_.vertex_sphere[other]; !move_together(network_.vertex_sphere[own], sphere)) {
      auto& [column, seen] = view.of_sphere[spheres_.ids[sphere]];
      column = sphere;
      // what is much smaller counts for less, as its own flow reaches less far
      const double part = std::min(1.0, 2.0 * spheres_.radii[sphere] / spheres_.radii[network_.vertex_sphere[own]]);
      seen += part * weight;
      view.of_small += (1.0 - part) * weight;
      view.periods += part * weight * (periods_of(other) - periods_of(own));
    } else {
      return;
    }
    view.all += weight;
  }

  bool move_together(int one, int other) const {
    return one == other || (!body_.empty() && body_[one] >= 0 && body_[one] == body_[other]);
  }

  Vector3d periods_of(Vertex vertex) const {
    const Lattice::Shift shift = pfv::periods_of(network_, spheres_, vertices_, vertex);
    return {static_cast<double>(shift[0]), static_cast<double>(shift[1]), static_cast<double>(shift[2])};
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
    if (!still_) return;
    double of_walls = 0.0;
    Matrix3d sum = Matrix3d::Zero();
    for (int f = 0; f < spheres_.wall_count(); ++f) {
      if (!(view.of_wall[f] > 0.0) || is_periodic(container_, f)) continue;
      of_walls += view.of_wall[f] / view.all;
      sum += view.of_wall[f] * carried_by(f, drag.sphere);
    }
    if (!(of_walls > 0.0)) return;
    of_walls += view.of_small / view.all;
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
  const bool still_;
  std::vector<View> views_;
};

/// What each sphere in question lacks, by itself or with the others of its body.
std::vector<OpenWaterDrag> drags_of_each(const PoreSources& pores, const Spheres& spheres, const Container& container,
                                         double viscosity, const std::vector<Matrix3d>& known,
                                         const std::vector<int>& body, const std::vector<char>& open, const Share& share) {
  const auto walls = [&](int k) { return wall_correction(container, spheres, k); };
  std::vector<MissingDrag> missing =
      missing_drags_of_bodies(pores, spheres, body, open, viscosity, walls, known, share);
  const std::vector<char> alone = spheres_alone(spheres.size(), body, share);
  for (int k = 0; k < spheres.size(); ++k) {
    if (!open[k] || !alone[k]) continue;
    PoresAround around;
    pores.add(k, around);
    const Matrix3d unbounded = spheres.radii[k] * Matrix3d::Identity(), wall = walls(k);
    Matrix3d lacking = -drag_of(around);
    lacking += 3.0 * pi * viscosity * (wall * unbounded + unbounded * wall);
    lacking -= known[k];
    missing.push_back({k, lacking});
  }
  std::sort(missing.begin(), missing.end(), [&](const MissingDrag& a, const MissingDrag& b) {
    return spheres.ids[a.sphere] < spheres.ids[b.sphere];
  });
  std::vector<OpenWaterDrag> drags;
  for (const MissingDrag& one : missing) drags.push_back({one.sphere, one.drag, {}, Vector3d::Zero(), {}});
  return drags;
}

/// What leans on a ghost may be unknown here.
void take_resistances_of_owners(std::vector<OpenWaterDrag>& drags, int spheres, const Share& share) {
  if (!share.ranks) return;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(9, spheres);
  for (const OpenWaterDrag& drag : drags) all.col(drag.sphere) = drag.resistance.reshaped();
  share.spheres.refresh(*share.ranks, all);
  for (OpenWaterDrag& drag : drags) drag.resistance = all.col(drag.sphere).reshaped(3, 3);
}

/// A sphere that others lean on is braked by these reactions as well, and lacks so much less: R of each is the part >=
/// 0 of what is missing less what the others' R do to it. A few damped rounds; what is left over is too much, not too
/// little.
void settle_reactions(std::vector<OpenWaterDrag>& drags, int spheres, const Share& share) {
  constexpr int rounds = 6;
  std::vector<Matrix3d> missing, reactions;
  for (OpenWaterDrag& drag : drags) {
    missing.push_back(drag.resistance);
    drag.resistance = positive_part(drag.resistance);
  }
  for (int round = 0; round < rounds; ++round) {
    reactions.assign(spheres, Matrix3d::Zero());
    for (const OpenWaterDrag& drag : drags)
      for (const auto& [sphere, weight] : drag.neighbours) reactions[sphere] += weight * weight * drag.resistance;
    for (std::size_t i = 0; i < drags.size(); ++i)
      drags[i].resistance =
          0.5 * (drags[i].resistance + positive_part(missing[i] - reactions[drags[i].sphere]));
    take_resistances_of_owners(drags, spheres, share);
  }
}

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

bool is_still(const Container& container) {
  if (!container.pressure_gradient.isZero(0.0)) return false;
  int open = 0;
  bool driven = false;
  double pressure = std::numeric_limits<double>::quiet_NaN();
  for (int number = 0; number < boundary_count(container); ++number) {
    const Boundary& boundary = boundary_of(container, number);
    if (!boundary.is_open()) continue;
    ++open;
    driven = driven || boundary.drives_flux() || boundary.profile;
    if (!boundary.imposes_pressure()) continue;
    driven = driven || (std::isfinite(pressure) && boundary.value != pressure);
    pressure = boundary.value;
  }
  return open < 2 || !driven;
}

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
                                            const std::vector<ResistanceBlock>& others, const std::vector<int>& body,
                                            bool still, const Share& share) {
  const std::vector<double> fractions = solid_fractions_around(network, throats, vertices);
  std::vector<char> open(spheres.size(), 0);
  for (int k = 0; k < static_cast<int>(fractions.size()); ++k) open[k] = fractions[k] < open_fraction && share.is_whole(k);
  if (!share.any(std::count(open.begin(), open.end(), 1) > 0)) return {};
  std::vector<Matrix3d> known(spheres.size(), Matrix3d::Zero());
  for (const auto& [of, by, block] : others)
    if (of == by) known[of] += block;
  std::vector<OpenWaterDrag> drags = drags_of_each(
      {network, conductances, matrix, imposed, ThroatLists(network), pore_names(network, share)}, spheres, container,
      viscosity, known, body, open, share);
  Surroundings(network, spheres, vertices, container, body, still).look(throats, drags);
  settle_reactions(drags, spheres.size(), share);
  for (OpenWaterDrag& drag : drags) drag.is_own = share.owns_sphere(drag.sphere);
  drags.erase(std::remove_if(drags.begin(), drags.end(), [&](const OpenWaterDrag& drag) {
                return (drag.neighbours.empty() && drag.faces.empty()) ||
                       drag.resistance.diagonal().maxCoeff() <= negligible * viscosity * spheres.radii[drag.sphere];
              }), drags.end());
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
      if (!drag.is_own) continue;
      loads.col(column).head<3>() += reaction;
      loads.col(column).tail<3>() += at.cross(reaction);
    }
  }
}

}  // namespace pfv
