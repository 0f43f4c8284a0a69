// SPDX-License-Identifier: GPL-3.0-or-later
#include "unseen_walls.h"

#include "wall_shapes.h"

#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace LAMMPS_NS {

namespace {

using Vector = Eigen::Vector3d;

constexpr int samples = 4000;       // of the container's volume and of a mesh's area
constexpr double noticed = 0.005;   // part of the volume
constexpr double touching = 0.1;    // depth of a mesh beyond a face, as part of the mean radius

/// Of places spread evenly: the digits of `number` in a base, behind the point and in reverse.
double halton(int number, int base) {
  double result = 0.0, part = 1.0;
  for (; number > 0; number /= base) result += (part /= base) * (number % base);
  return result;
}

double depth_in(const pfv::Container& container, const Vector& place) {
  double depth = std::numeric_limits<double>::max();
  for (const pfv::ContainerFace& face : container.faces) depth = std::min(depth, face.surface.distance(place));
  return depth;
}

/// The part of the container's volume that is on the other side of a wall than most grains.
double part_beyond(const pfv::Surface& wall, const pfv::Container& container, const pfv::Packing& packing,
                   const PfvFlowRanks& ranks) {
  double before = 0.0;
  for (Eigen::Index k = 0; k < packing.size(); ++k) before += wall.distance(packing.positions.col(k)) > 0.0;
  const bool fluid_before = 2.0 * ranks.sum(before) >= ranks.sum(static_cast<double>(packing.size()));
  int within = 0, beyond = 0;
  for (int i = 1; i <= samples; ++i) {
    const Vector part(halton(i, 2), halton(i, 3), halton(i, 5));
    const Vector place = container.lower + part.cwiseProduct(container.upper - container.lower);
    if (depth_in(container, place) <= 0.0) continue;
    ++within;
    beyond += (wall.distance(place) > 0.0) != fluid_before;
  }
  return within > 0 ? static_cast<double>(beyond) / within : 0.0;
}

struct Deepest {
  double depth = 0.0;
  Vector place = Vector::Zero();
};

/// Where a mesh reaches furthest into the container: at its corners, or between them.
Deepest deepest_in(const pfv::Container& container, const std::vector<pfv::Triangle>& triangles) {
  Deepest deepest;
  const int rows = std::clamp(static_cast<int>(std::sqrt(2.0 * samples / static_cast<double>(triangles.size()))), 1, 40);
  for (const pfv::Triangle& triangle : triangles)
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; i + j <= rows; ++j) {
        const Vector place = triangle * (Vector(i, j, rows - i - j) / rows);
        if (const double depth = depth_in(container, place); depth > deepest.depth) deepest = {depth, place};
      }
  return deepest;
}

std::string remedy(const pfv::Container& container, const PfvUnseenWall& wall) {
  if (container.any_periodic() && !wall.surface.empty())
    return "; beside periodic sides walls are parallel to them, and there are no obstacles";
  if (container.any_periodic())
    return "; beside periodic sides there are no obstacles, and walls that bound the fluid are parallel to those sides "
           "(`container walls`)";
  const std::string obstacle = wall.surface.empty() ? "`obstacle mesh " + wall.id + "` makes it a body among the grains" : "";
  if (!container.is_box && !wall.surface.empty() && !wall.surface[0].is_plane())
    return "; if it stands among the grains, take a mesh of its shape in its place, and `obstacle mesh ID`";
  if (!container.is_box) return obstacle.empty() ? "; give the container a face for it" : "; " + obstacle;
  return "; take `container walls`, or a `container` with a face for this wall, if it bounds the fluid" +
         (obstacle.empty() ? "" : "; " + obstacle);
}

}  // namespace

std::vector<PfvUnseenWall> walls_beside_the_faces(LAMMPS* lmp, int groupbit, const PfvSettings& settings) {
  std::vector<PfvUnseenWall> unseen;
  for (const PfvWall& wall : PfvFoundWalls(lmp, groupbit).walls()) {
    const auto is_this = [&](const auto& one) { return one.fix_id == wall.id; };
    const bool seen = std::any_of(settings.sources.begin(), settings.sources.end(), is_this) ||
                      std::any_of(settings.obstacles.begin(), settings.obstacles.end(), is_this);
    if (seen) continue;
    unseen.push_back({wall.id, {}, {}});
    if (wall.mesh) unseen.back().triangles = triangles_of(wall.mesh, lmp->world);
    if (wall.primitive) unseen.back().surface = {surface_of(wall.primitive, "wall '" + wall.id + "' ")};
  }
  return unseen;
}

std::vector<std::string> warnings_of_unseen_walls(const std::vector<PfvUnseenWall>& walls,
                                                  const pfv::Container& container, const pfv::Packing& packing,
                                                  const PfvFlowRanks& ranks) {
  std::vector<std::string> warnings;
  const double mean_radius = totals_of(packing, ranks).mean_radius;
  if (!ranks.any(packing.size() > 0)) return warnings;
  for (const PfvUnseenWall& wall : walls) {
    std::ostringstream text;
    text.precision(3);
    if (!wall.surface.empty()) {
      const double part = part_beyond(wall.surface[0], container, packing, ranks);
      if (part < noticed) continue;
      text << "wall '" << wall.id << "' cuts off " << 100.0 * part << " % of what is taken as the fluid's room, where no grain "
           << "can be and water flows without resistance" << remedy(container, wall);
    } else {
      const Deepest deepest = deepest_in(container, wall.triangles);
      if (deepest.depth <= touching * mean_radius) continue;
      text << "mesh '" << wall.id << "' stands in the fluid, which does not see it: it reaches " << deepest.depth
           << " m into it at (" << deepest.place[0] << ", " << deepest.place[1] << ", " << deepest.place[2] << "); water flows through it, and it displaces none"
           << remedy(container, wall);
    }
    warnings.push_back(text.str());
  }
  return warnings;
}

}  // namespace LAMMPS_NS
