// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "pfv/mesh_walls.hpp"
#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace pfv {

/// A body inside the container, as the fluid sees it: overlapping spheres of one rigid body in place of a mesh.
///
/// A part of the mesh that is closed is filled with spheres inside it that touch its surface (the largest ones:
/// Ma, Bae & Choi 2012, "3D medial axis point approximation using nearest neighbors and the normal field"; Ferellec &
/// McDowell 2010), so few as leave no place of the surface further than a tenth of `diameter` from them, edges and corners
/// excepted, which are rounded; then all are grown alike until their union has the volume of the mesh. An open part is
/// a sheet: spheres of 0.6 `diameter` centred on it, so near each other that no fluid passes between them. So are
/// walls of a closed part that are thinner than this.
struct Obstacle {
  Eigen::Matrix3Xd centres;   ///< m
  Eigen::VectorXd radii;      ///< m
  Eigen::VectorXd displaced;  ///< m³, what each displaces: they add up to `volume`, and lift at its centre
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m: of the volume, or of a sheet's area
  double volume = 0.0;        ///< of the closed parts of the mesh, m³; 0 for sheets
  double union_volume = 0.0;  ///< of all spheres, m³
  double recess = 0.0;        ///< m, the furthest that a place of the mesh is outside of the spheres
  double protrusion = 0.0;    ///< m, the furthest that the spheres stand out of the mesh: half of a sheet's thickness
  int solids = 0, sheets = 0;  ///< closed and open parts

  Eigen::Index size() const { return radii.size(); }
};

/// The spheres that stand for a mesh. `diameter` (m, > 0): of the smallest spheres in a closed part; half the grains' mean
/// diameter is a good choice (`usual_obstacle_diameter`). Triangles of a closed part may point either way.
///
/// Throws InputError, which begins with `what`, for a mesh without area, a coordinate that is not finite, and one that
/// would need more than `most_obstacle_spheres`. Cost: places of the surface (some 70 area / diameter²) times spheres.
Obstacle obstacle_of_mesh(const std::vector<Triangle>& triangles, double diameter, const std::string& what);
inline constexpr double usual_obstacle_diameter = 0.5;  ///< as a part of the grains' mean diameter
inline constexpr int most_obstacle_spheres = 20000;

/// Where a rigid thing is, against where it was: x -> turn x + shift.
struct Placement {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< m

  Eigen::Vector3d of(const Eigen::Vector3d& place) const { return turn * place + shift; }
};
/// The rigid motion that takes one mesh nearest to another with the same triangles (least squares: Kabsch 1976).
/// Throws InputError, which begins with `what`, where corners stray from it by more than `planarity` of the mesh's size:
/// it has changed its shape.
Placement placement_between(const std::vector<Triangle>& before, const std::vector<Triangle>& now,
                            const std::string& what);

/// How an obstacle moves: v = velocity + spin x (place - pivot).
struct ObstacleMotion {
  Placement placement;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< m
};
/// Puts its spheres behind those of a packing, as the spheres of one more rigid body. Their ids count from
/// `first_id` on. Arrays of the packing that were empty and no longer can be are filled: bodies with -1, displaced
/// volumes with those of whole spheres, velocities with 0.
///
/// Where the obstacle reaches through a face without a pressure that it does not move towards or away from, a sphere with its centre beyond
/// the face is replaced by one with the same cut in it, so that no gap is left at the wall; other spheres beyond
/// a face take no part.
void add_obstacle(PackingArrays& packing, const Obstacle& obstacle, const ObstacleMotion& motion,
                  std::int64_t first_id, const Container& container);
/// The rigid body that these spheres are, which no force moves.
RigidBody held_body(const Obstacle& obstacle, const Placement& placement);

/// Ids of the spheres of a packing that stick in an obstacle where it stands: their centre is within one of its spheres.
/// Programs that place grains at random often leave some there, which then go along with it.
std::vector<std::int64_t> spheres_stuck_in(const Packing& packing, const Obstacle& obstacle, const Placement& placement);
/// What to say of them; empty where there are none.
std::string warning_of_stuck(std::vector<std::int64_t> ids);

/// What one of several ranks has of an obstacle: these of its spheres, ascending, as this rigid body of the packing.
struct ObstaclePart {
  std::vector<int> spheres;
  int body = 0;
};
void add_obstacle(PackingArrays& packing, const Obstacle& obstacle, const ObstaclePart& part, const ObstacleMotion& motion,
                  std::int64_t first_id, const Container& container);
RigidBody held_body(const Obstacle& obstacle, const ObstaclePart& part, const Placement& placement);

/// Force (N) and moment (N m) about `centre` (m) of the fluid on the spheres from column `first` on, `count` of them.
struct ObstacleLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
};
ObstacleLoad load_on(const Packing& packing, const Forces& forces, Eigen::Index first, Eigen::Index count,
                     const Eigen::Vector3d& centre);

/// The triangles of an STL file, text or binary, m, in its order. Throws InputError naming file and line.
std::vector<Triangle> read_stl(const std::string& path);

}  // namespace pfv
