// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/mesh_parts.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// A sphere that may stand for a piece of a mesh.
struct ObstacleBall {
  Eigen::Vector3d centre;
  double inscribed = 0.0;  ///< m, radius of the largest ball in the body around this centre; 0 on a sheet
  double radius = 0.0;     ///< m, not less than that
  double reach = 0.0;      ///< m, from its centre, of the places that it stands for
};

/// A place of the mesh that must be stood for.
struct ObstaclePlace {
  Eigen::Vector3d place;
  double area = 0.0;    ///< m²
  double beyond = 0.0;  ///< m, from what the nearest of the chosen balls reaches
};

struct ObstaclePlaces {
  std::vector<ObstaclePlace> places;
  std::vector<ObstacleBall> balls;
};

/// Places some diameter / 4 apart all over the part, and the balls of its surface: of a sheet around these places, in a
/// closed part those that touch the surface there from within and are as large as others of its triangles allow.
ObstaclePlaces places_of(const MeshPart& part, double diameter);

/// So few of the balls as reach all places, in the order in which they were chosen.
std::vector<ObstacleBall> chosen_balls(const ObstaclePlaces& all, double diameter, std::size_t most);

}  // namespace pfv
