// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_obstacles.hpp"

#include "distributed/even_rows.hpp"
#include "network/grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// A sum and what its roundings have left out (Neumaier 1974).
struct Sum {
  double value = 0.0, rest = 0.0;
  void add(double term) {
    const double sum = value + term;
    rest += std::abs(value) >= std::abs(term) ? (value - sum) + term : (term - sum) + value;
    value = sum;
  }
};

/// The grains of all ranks in one: however they are divided, obstacles get the same spheres.
struct Grains {
  Eigen::Index count = 0;
  double mean_radius = 0.0;
  std::int64_t last_id = 0;

  Grains(const PackingArrays& own, const Ranks& ranks) : count(rows_of_all(own.ids.size(), ranks)) {
    Sum sum;
    for (const double radius : own.radii) sum.add(radius);
    const double sums[2] = {sum.value, sum.rest};
    const std::int64_t last = own.ids.size() > 0 ? own.ids.maxCoeff() : std::numeric_limits<std::int64_t>::min();
    Ranks::Bytes of_sums, of_ids;
    append(of_sums, sums, 2);
    append(of_ids, &last, 1);
    Sum all;
    for (const Ranks::Bytes& part : ranks.gather(of_sums))
      for (const double term : values_in<double>(part)) all.add(term);
    if (count == 0) return;
    mean_radius = (all.value + all.rest) / static_cast<double>(count);
    last_id = std::numeric_limits<std::int64_t>::min();
    for (const Ranks::Bytes& part : ranks.gather(of_ids)) last_id = std::max(last_id, values_in<std::int64_t>(part)[0]);
  }
};

/// Of the grains of all ranks.
std::vector<std::int64_t> stuck_on(const Ranks& ranks, const Packing& grains, const Obstacle& obstacle) {
  const std::vector<std::int64_t> own = spheres_stuck_in(grains, obstacle, {});
  Ranks::Bytes bytes;
  append(bytes, own.data(), own.size());
  std::vector<std::int64_t> all;
  for (const Ranks::Bytes& part : ranks.gather(bytes))
    for (const std::int64_t id : values_in<std::int64_t>(part)) all.push_back(id);
  return all;
}

/// On the last rank, behind its spheres; other ranks get the arrays for it. Returns how many are in the container.
Eigen::Index put_behind(PackingArrays& packing, const Obstacle& obstacle, std::int64_t first_id, const Container& container,
                        const Ranks& ranks) {
  const Eigen::Index first = packing.ids.size();
  ranks.together([&] {
    if (ranks.own() + 1 == ranks.count()) add_obstacle(packing, obstacle, {}, first_id, container);
    else add_obstacle(packing, obstacle, ObstaclePart(), {}, first_id, container);
    drop_outside(packing, first, container);
  });
  return static_cast<Eigen::Index>(ranks.sum(static_cast<double>(packing.ids.size() - first)));
}

}  // namespace

std::vector<StandingObstacle> add_obstacles(const SolveRequest& request, PackingArrays& packing, std::ostream& warnings,
                                            const Ranks& ranks) {
  std::vector<StandingObstacle> all;
  if (request.obstacles.empty()) return all;
  const Grains grains(packing, ranks);
  const Eigen::Index own_grains = packing.ids.size();
  Eigen::Index first = grains.count;
  for (const std::string& file : request.obstacles) {
    const double usual = 2.0 * usual_obstacle_diameter * grains.mean_radius;
    const double diameter = request.obstacle_diameter > 0.0 ? request.obstacle_diameter : usual;
    Obstacle obstacle;
    ranks.together([&] { obstacle = obstacle_of_mesh(read_stl(file), diameter, file + ": it "); });
    const std::string warning = warning_of_stuck(stuck_on(ranks, first_spheres(packing.view(), own_grains), obstacle));
    if (!warning.empty()) warnings << "pfv: warning: " << file << ": " << warning << '\n';
    const Eigen::Index count = put_behind(packing, obstacle, grains.last_id + 1 + first, request.container, ranks);
    all.push_back({std::move(obstacle), first, count});
    first += count;
  }
  packing = evenly_divided(std::move(packing), ranks);
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
