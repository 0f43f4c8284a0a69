// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve_arguments.hpp"

#include "parallel/ranks.hpp"
#include "pfv/obstacle.hpp"
#include "pfv/report.hpp"

#include <ostream>
#include <string>
#include <vector>

namespace pfv::app {

/// What stands for the file of an `--obstacle`, as columns of the packing of all ranks.
struct StandingObstacle {
  Obstacle obstacle;
  Eigen::Index first, count;
};

/// Puts the spheres of each obstacle behind the grains of all ranks, as far as they are in the container, and divides all
/// evenly; warns of grains that stick in it. Collective.
std::vector<StandingObstacle> add_obstacles(const SolveRequest& request, PackingArrays& packing, std::ostream& warnings,
                                            const Ranks& ranks);

/// `rows`: those of the packing that this rank has read, from `first_row` on, and what acts on them. Collective on ranks.
std::vector<ObstacleResult> results_of(const std::vector<StandingObstacle>& obstacles, const SolveRequest& request,
                                       const Forces& forces, const Packing& rows, Eigen::Index first_row,
                                       const Ranks* ranks);

/// Of the first `count` spheres alone: the grains, in front of the obstacles.
Packing first_spheres(const Packing& packing, Eigen::Index count);
Forces first_forces(const Forces& forces, Eigen::Index count);

}  // namespace pfv::app
