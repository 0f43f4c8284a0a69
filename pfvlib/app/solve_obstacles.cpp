// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_obstacles.hpp"

#include "network/grains.hpp"

#include <algorithm>
#include <utility>

namespace pfv::app {

namespace {

/// Keeps the spheres from `first` on that are in the container.
void drop_outside(PackingArrays& packing, Eigen::Index first, const Container& container) {
  std::vector<int> kept;
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
    if (k < first || is_inside(packing.view(), k, container)) kept.push_back(static_cast<int>(k));
  packing.ids = Packing::Ids(packing.ids(kept));
  packing.positions = Eigen::Matrix3Xd(packing.positions(Eigen::all, kept));
  packing.radii = Eigen::VectorXd(packing.radii(kept));
  packing.displaced_volumes = Eigen::VectorXd(packing.displaced_volumes(kept));
  packing.bodies = Eigen::VectorXi(packing.bodies(kept));
  for (Eigen::Matrix3Xd* motion : {&packing.velocities, &packing.angular_velocities})
    if (motion->cols() > 0) *motion = Eigen::Matrix3Xd((*motion)(Eigen::all, kept));
}

}  // namespace

std::vector<StandingObstacle> add_obstacles(const SolveRequest& request, PackingArrays& packing, std::ostream& warnings) {
  std::vector<StandingObstacle> all;
  const double usual = packing.radii.size() > 0 ? 2.0 * usual_obstacle_diameter * packing.radii.mean() : 0.0;
  const Eigen::Index grains = packing.ids.size();
  const std::int64_t last_id = packing.ids.size() > 0 ? packing.ids.maxCoeff() : 0;
  for (const std::string& file : request.obstacles) {
    const double diameter = request.obstacle_diameter > 0.0 ? request.obstacle_diameter : usual;
    const Eigen::Index first = packing.ids.size();
    Obstacle obstacle = obstacle_of_mesh(read_stl(file), diameter, file + ": it ");
    const std::string warning = warning_of_stuck(spheres_stuck_in(first_spheres(packing.view(), grains), obstacle, {}));
    if (!warning.empty()) warnings << "pfv: warning: " << file << ": " << warning << '\n';
    add_obstacle(packing, obstacle, {}, last_id + 1 + first, request.container);
    drop_outside(packing, first, request.container);
    all.push_back({std::move(obstacle), first, packing.ids.size() - first});
  }
  return all;
}

std::vector<ObstacleResult> results_of(const std::vector<StandingObstacle>& obstacles, const SolveRequest& request,
                                       const Forces& forces, const Packing& rows, Eigen::Index first_row,
                                       const Ranks* ranks) {
  std::vector<ObstacleResult> results;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const auto& [obstacle, first, count] = obstacles[i];
    const Eigen::Index begin = std::clamp<Eigen::Index>(first - first_row, 0, rows.size());
    const Eigen::Index end = std::clamp<Eigen::Index>(first + count - first_row, 0, rows.size());
    ObstacleLoad load = load_on(rows, forces, begin, end - begin, obstacle.centre);
    for (Eigen::Vector3d* part : {&load.force, &load.moment})
      if (ranks) ranks->add(part->data(), 3);
    results.push_back({request.obstacles[i], count, obstacle.volume, obstacle.union_volume, obstacle.recess,
                       obstacle.protrusion, obstacle.centre, load.force, load.moment});
  }
  return results;
}

Packing first_spheres(const Packing& packing, Eigen::Index count) {
  Packing first;
  new (&first.ids) decltype(first.ids)(packing.ids.data(), count);
  new (&first.positions) decltype(first.positions)(packing.positions.data(), 3, count);
  new (&first.radii) decltype(first.radii)(packing.radii.data(), count);
  return first;
}

Forces first_forces(const Forces& forces, Eigen::Index count) {
  Forces first;
  for (Eigen::Matrix3Xd Forces::*part : {&Forces::total, &Forces::pressure, &Forces::viscous})
    if ((forces.*part).cols() > 0) first.*part = (forces.*part).leftCols(count);
  return first;
}

}  // namespace pfv::app
