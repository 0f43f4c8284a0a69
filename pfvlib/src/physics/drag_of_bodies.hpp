// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "physics/drag_of_pores.hpp"

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace pfv {

/// A sphere of a rigid body in open water and what it lacks of its drag, kg/s.
struct MissingDrag {
  int sphere;
  Eigen::Matrix3d drag;
};

/// A body of more spheres than this, an obstacle, keeps the drag of the network: that of its beads costs the cube of their
/// number.
constexpr int most_beads = 200;

/// Of each sphere whether it moves by itself, in no body with another on whatever rank. Collective.
std::vector<char> spheres_alone(int spheres, const std::vector<int>& body, const Share& share);

/// Of the bodies of two spheres and more, one of which is `open`, what all their spheres lack together, each its part.
/// `body`: of each sphere, -1 for none, or no entries; `walls`: W of one (physics/open_water.hpp). On several ranks
/// those with own spheres tell one of them; own spheres and ghosts are returned. Collective.
std::vector<MissingDrag> missing_drags_of_bodies(const PoreSources& pores, const Spheres& spheres,
                                                 const std::vector<int>& body, const std::vector<char>& open,
                                                 double viscosity, const std::function<Eigen::Matrix3d(int)>& walls,
                                                 const std::vector<Eigen::Matrix3d>& known, const Share& share);

}  // namespace pfv
