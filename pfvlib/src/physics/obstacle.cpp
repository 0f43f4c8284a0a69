// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/obstacle.hpp"

#include "geometry/pi.hpp"
#include "physics/obstacle_places.hpp"
#include "pfv/error.hpp"
#include "pfv/union_parts.hpp"
#include "text/number_text.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;

void check_mesh(const std::vector<Triangle>& triangles, double diameter, const std::string& what) {
  if (triangles.empty()) throw InputError(what + "has no triangles");
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!triangles[t].allFinite())
      throw InputError(what + "has a corner that is not finite, in its triangle " + std::to_string(t + 1));
  if (!(diameter > 0.0) || !std::isfinite(diameter))
    throw InputError(what + "needs spheres of a positive diameter, not " + detail::number_text(diameter) + " m");
}

/// Before anything large is built: places of the surface go with the square.
void refuse_too_fine(const std::vector<MeshPart>& parts, double diameter, const std::string& what) {
  double area = 0.0;
  for (const MeshPart& part : parts) area += part.area;
  const double rough = area / (diameter * diameter);  // a sheet takes some four spheres a square of the diameter
  if (rough < 0.5 * most_obstacle_spheres) return;
  throw InputError(what + "is too large for spheres of diameter " + detail::number_text(diameter) + " m: its area of " +
                   detail::number_text(area) + " m2 would need more than " + std::to_string(most_obstacle_spheres) +
                   " of them; give a larger diameter, or leave away what is outside of the fluid");
}

struct Standing {
  std::vector<ObstacleBall> balls;
  double recess = 0.0;
};

double furthest_outside(const std::vector<ObstaclePlace>& places, const std::vector<ObstacleBall>& balls) {
  double furthest = 0.0;
  for (const ObstaclePlace& one : places) {
    double outside = std::numeric_limits<double>::max();
    for (const ObstacleBall& ball : balls) outside = std::min(outside, (one.place - ball.centre).norm() - ball.radius);
    furthest = std::max(furthest, outside);
  }
  return furthest;
}

double union_of(const std::vector<ObstacleBall>& balls) {
  Eigen::Matrix3Xd centres(3, static_cast<Eigen::Index>(balls.size()));
  Eigen::VectorXd radii(centres.cols());
  for (std::size_t k = 0; k < balls.size(); ++k) {
    centres.col(static_cast<Eigen::Index>(k)) = balls[k].centre;
    radii[static_cast<Eigen::Index>(k)] = balls[k].radius;
  }
  return union_parts(centres, radii).sum();
}

/// All radii alike, until the balls together have the volume of the mesh: Newton's steps with the mesh's area.
void grow(std::vector<ObstacleBall>& balls, const MeshPart& part, double diameter) {
  constexpr double most = 0.2;  // of the diameter
  double grown = 0.0;
  for (int turn = 0; turn < 3; ++turn) {
    const double more = std::min((part.volume - union_of(balls)) / part.area, most * diameter - grown);
    if (grown + more < 0.0) return;  // fattened walls are too large
    for (ObstacleBall& ball : balls) ball.radius += more;
    grown += more;
  }
}

/// Takes the balls of a symmetric mesh off the common spheres and planes that their centres lie on, by next to nothing
/// and always alike: a triangulation of them is one of many, and volumes summed over its flat cells lose digits.
void break_symmetry(std::vector<ObstacleBall>& balls, double diameter) {
  constexpr double little = 1e-5;
  std::uint32_t state = 1;
  for (ObstacleBall& ball : balls)
    for (double& coordinate : ball.centre) {
      state = 1664525u * state + 1013904223u;  // Numerical Recipes' generator
      coordinate += little * diameter * (state / 4294967296.0 - 0.5);
    }
}

Standing stand_for(const MeshPart& part, double diameter, const std::string& what) {
  const ObstaclePlaces all = places_of(part, diameter);
  Standing standing{chosen_balls(all, diameter, most_obstacle_spheres), 0.0};
  if (standing.balls.empty())
    throw InputError(what + "has a closed part of " + detail::number_text(part.volume) +
                     " m3 that is too small for spheres of diameter " + detail::number_text(diameter) +
                     " m; give a smaller diameter, or leave the part away");
  if (standing.balls.size() == most_obstacle_spheres)
    throw InputError(what + "would need more than " + std::to_string(most_obstacle_spheres) + " spheres of diameter " +
                     detail::number_text(diameter) + " m; give a larger one");
  break_symmetry(standing.balls, diameter);
  if (part.closed) grow(standing.balls, part, diameter);
  standing.recess = furthest_outside(all.places, standing.balls);
  return standing;
}

/// Each sphere's share of the mesh's volume: that in the union of the closed parts' spheres, scaled.
Eigen::VectorXd displaced_of(const std::vector<Standing>& standing, const std::vector<MeshPart>& parts,
                             Obstacle& obstacle) {
  Eigen::VectorXd displaced = Eigen::VectorXd::Zero(obstacle.size());
  std::vector<int> solid;
  double separate = 0.0;  // parts may lie in each other: their own unions
  int first = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const int count = static_cast<int>(standing[p].balls.size());
    std::vector<int> own(count);
    for (int k = 0; k < count; ++k) own[k] = first + k;
    first += count;
    if (!parts[p].closed) continue;
    solid.insert(solid.end(), own.begin(), own.end());
    separate += union_parts(obstacle.centres(Eigen::all, own), obstacle.radii(own)).sum();
  }
  if (solid.empty()) return displaced;
  const Eigen::Matrix3Xd centres = obstacle.centres(Eigen::all, solid);
  displaced(solid) = displaced_volumes(centres, obstacle.radii(solid), obstacle.centre);
  double volume = 0.0;
  for (const MeshPart& part : parts) volume += part.volume;
  displaced *= volume / separate;
  return displaced;
}

Vector centre_of(const std::vector<MeshPart>& parts) {
  Vector sum = Vector::Zero(), of_area = Vector::Zero();
  double volume = 0.0, area = 0.0;
  for (const MeshPart& part : parts) {
    sum += part.volume * part.centre;
    volume += part.volume;
    of_area += part.area * part.centre;
    area += part.area;
  }
  return volume > 0.0 ? Vector(sum / volume) : Vector(of_area / area);
}

}  // namespace

Obstacle obstacle_of_mesh(const std::vector<Triangle>& triangles, double diameter, const std::string& what) {
  check_mesh(triangles, diameter, what);
  const std::vector<MeshPart> parts = parts_of_mesh(triangles);
  if (parts.empty()) throw InputError(what + "has no area");
  refuse_too_fine(parts, diameter, what);
  std::vector<Standing> standing;
  Obstacle obstacle;
  Eigen::Index count = 0;
  for (const MeshPart& part : parts) {
    standing.push_back(stand_for(part, diameter, what));
    count += static_cast<Eigen::Index>(standing.back().balls.size());
    ++(part.closed ? obstacle.solids : obstacle.sheets);
    obstacle.recess = std::max(obstacle.recess, standing.back().recess);
  }
  obstacle.centres.resize(3, count);
  obstacle.radii.resize(count);
  Eigen::Index k = 0;
  for (const Standing& one : standing)
    for (const ObstacleBall& ball : one.balls) {
      obstacle.centres.col(k) = ball.centre;
      obstacle.radii[k++] = ball.radius;
      obstacle.protrusion = std::max(obstacle.protrusion, ball.radius - ball.inscribed);
    }
  obstacle.centre = centre_of(parts);
  obstacle.union_volume = union_parts(obstacle.centres, obstacle.radii).sum();
  obstacle.displaced = displaced_of(standing, parts, obstacle);
  obstacle.volume = obstacle.displaced.sum();
  return obstacle;
}

Placement placement_between(const std::vector<Triangle>& before, const std::vector<Triangle>& now,
                            const std::string& what) {
  if (before.size() != now.size())
    throw InputError(what + "has " + std::to_string(now.size()) + " triangles now and had " +
                     std::to_string(before.size()) + "; define fix pfv anew");
  Vector from = Vector::Zero(), to = Vector::Zero();
  for (std::size_t t = 0; t < now.size(); ++t) {
    from += before[t].rowwise().mean() / static_cast<double>(now.size());
    to += now[t].rowwise().mean() / static_cast<double>(now.size());
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < now.size(); ++t)
    covariance += (now[t].colwise() - to) * (before[t].colwise() - from).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  Placement placement;
  placement.turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  double strayed = 0.0, moved = 0.0;
  for (std::size_t t = 0; t < now.size(); ++t) {
    const Triangle where = (placement.turn * (before[t].colwise() - from)).colwise() + to;
    strayed = std::max(strayed, (where - now[t]).colwise().norm().maxCoeff());
    moved = std::max(moved, ((now[t] - before[t]).colwise() - (to - from)).colwise().norm().maxCoeff());
  }
  if (strayed > planarity * size_of(before))
    throw InputError(what + "has changed its shape: its corners stray by " + detail::number_text(strayed) +
                     " m from a rigid motion; an obstacle may be moved and turned, not deformed");
  if (moved < 1e-14 * size_of(before)) placement.turn.setIdentity();  // a plain translation, to the last digit
  placement.shift = to - placement.turn * from;
  return placement;
}

namespace {

/// The sphere within the faces, with the cut of the whole one in each face that it stands across at rest.
void draw_in(Vector& centre, double& radius, const Vector& velocity, const Container& container) {
  constexpr double within = 0.02, least = 0.3;  // of the radius: depth of the centre, and what is worth keeping
  const double whole = radius;
  for (const ContainerFace& face : container.faces) {
    if (face.boundary.imposes_pressure()) continue;  // no wall
    const double distance = face.surface.distance(centre);
    if (distance > 0.0 || distance <= -radius) continue;
    const Vector inward = -face.surface.outward_at(centre);
    if (std::abs(inward.dot(velocity - face.velocity)) > 1e-9 * velocity.norm()) continue;
    const double cut = std::sqrt(radius * radius - distance * distance);
    if (cut < least * whole) continue;
    radius = cut;
    centre += (within * radius - distance) * inward;
  }
}

}  // namespace

void add_obstacle(PackingArrays& packing, const Obstacle& obstacle, const ObstacleMotion& motion,
                  std::int64_t first_id, const Container& container) {
  ObstaclePart all;
  all.spheres.resize(static_cast<std::size_t>(obstacle.size()));
  std::iota(all.spheres.begin(), all.spheres.end(), 0);
  all.body = packing.bodies.size() > 0 && packing.ids.size() > 0 ? packing.bodies.maxCoeff() + 1 : 0;
  add_obstacle(packing, obstacle, all, motion, first_id, container);
}

void add_obstacle(PackingArrays& packing, const Obstacle& obstacle, const ObstaclePart& part, const ObstacleMotion& motion,
                  std::int64_t first_id, const Container& container) {
  const Eigen::Index before = packing.ids.size(), own = static_cast<Eigen::Index>(part.spheres.size()), all = before + own;
  if (packing.bodies.size() != before) packing.bodies = Eigen::VectorXi::Constant(before, -1);
  if (packing.displaced_volumes.size() != before)
    packing.displaced_volumes = 4.0 / 3.0 * pi * packing.radii.array().cube();
  const bool still = packing.velocities.cols() == 0 && packing.angular_velocities.cols() == 0 &&
                     motion.velocity.isZero(0.0) && motion.spin.isZero(0.0);
  for (Eigen::Matrix3Xd* motions : {&packing.velocities, &packing.angular_velocities})
    if (!still && motions->cols() != before) *motions = Eigen::Matrix3Xd::Zero(3, before);
  packing.ids.conservativeResize(all);
  packing.radii.conservativeResize(all);
  packing.bodies.conservativeResize(all);
  packing.displaced_volumes.conservativeResize(all);
  packing.positions.conservativeResize(3, all);
  if (!still) packing.velocities.conservativeResize(3, all);
  if (!still) packing.angular_velocities.conservativeResize(3, all);
  for (Eigen::Index k = 0; k < own; ++k) {
    const int sphere = part.spheres[k];
    Vector place = motion.placement.of(obstacle.centres.col(sphere));
    double radius = obstacle.radii[sphere];
    const Vector velocity = motion.velocity + motion.spin.cross(place - motion.pivot);
    draw_in(place, radius, velocity, container);
    packing.ids[before + k] = first_id + sphere;
    packing.positions.col(before + k) = place;
    packing.radii[before + k] = radius;
    if (still) continue;
    packing.velocities.col(before + k) = motion.velocity + motion.spin.cross(place - motion.pivot);
    packing.angular_velocities.col(before + k) = motion.spin;
  }
  packing.bodies.tail(own).setConstant(part.body);
  packing.displaced_volumes.tail(own) = obstacle.displaced(part.spheres);
}

std::vector<std::int64_t> spheres_stuck_in(const Packing& packing, const Obstacle& obstacle, const Placement& placement) {
  std::vector<std::pair<double, int>> along;  // x of the obstacle's spheres, sorted
  Eigen::Matrix3Xd centres(3, obstacle.size());
  for (int j = 0; j < obstacle.size(); ++j) {
    centres.col(j) = placement.of(obstacle.centres.col(j));
    along.emplace_back(centres(0, j), j);
  }
  std::sort(along.begin(), along.end());
  const double widest = obstacle.size() > 0 ? obstacle.radii.maxCoeff() : 0.0;
  std::vector<std::int64_t> ids;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const Vector place = packing.positions.col(k);
    const auto is_within = [&](const std::pair<double, int>& ball) {
      return (centres.col(ball.second) - place).norm() < obstacle.radii[ball.second];
    };
    const auto begin = std::lower_bound(along.begin(), along.end(), std::pair(place.x() - widest, -1));
    const auto end = std::upper_bound(begin, along.end(), std::pair(place.x() + widest, std::numeric_limits<int>::max()));
    if (std::any_of(begin, end, is_within)) ids.push_back(packing.ids[k]);
  }
  return ids;
}

std::string warning_of_stuck(std::vector<std::int64_t> ids) {
  constexpr std::size_t shown = 5;
  if (ids.empty()) return {};
  std::sort(ids.begin(), ids.end());
  std::string text = std::to_string(ids.size()) + (ids.size() == 1 ? " grain sticks" : " grains stick") +
                     " in it, the centre within its body (";
  for (std::size_t k = 0; k < std::min(shown, ids.size()); ++k) text += (k ? ", " : "") + std::to_string(ids[k]);
  return text + (ids.size() > shown ? ", ..." : "") +
         "): fluid that they and it close in shares the pressure around; delete them, or place grains beside it alone";
}

RigidBody held_body(const Obstacle& obstacle, const Placement& placement) {
  RigidBody body;
  body.arms = placement.turn * (obstacle.centres.colwise() - obstacle.centre);
  body.masses.setConstant(std::numeric_limits<double>::infinity());
  body.inertias = body.masses;
  return body;
}

RigidBody held_body(const Obstacle& obstacle, const ObstaclePart& part, const Placement& placement) {
  RigidBody body = held_body(obstacle, placement);
  body.arms = Eigen::Matrix3Xd(body.arms(Eigen::all, part.spheres));
  return body;
}

ObstacleLoad load_on(const Packing& packing, const Forces& forces, Eigen::Index first, Eigen::Index count,
                     const Eigen::Vector3d& centre) {
  ObstacleLoad load;
  for (Eigen::Index k = first; k < first + count; ++k) {
    const Vector force = forces.total.col(k), arm = packing.positions.col(k) - centre;
    load.force += force;
    load.moment += arm.cross(force);
    if (forces.torque.cols() > 0) load.moment += forces.torque.col(k);
  }
  return load;
}

}  // namespace pfv
