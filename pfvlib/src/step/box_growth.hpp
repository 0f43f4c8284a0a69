// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/rigid_motion.hpp"
#include "problem/container_geometry.hpp"
#include "step/built_network.hpp"

namespace pfv {

// A network is kept while the container changes: volumes and forces that follow the container as it is.

/// What each face's load of a unit pressure (area with direction, and its moment) has grown by since the network
/// was built: until the middle of the step that the velocities belong to, and until now. With those of the middle
/// the faces sweep just what the container's volume changes by.
struct BoxGrowth {
  Matrix6Xd in_the_middle, now;
};
/// `present`: of the container as it is; `ahead`, s: from now to that middle.
BoxGrowth growth_of(const Container& container, const ContainerGeometry& present, const BuiltNetwork& built,
                    double ahead);

/// What the container grows by beyond the rates of the network as it was built, m³/s.
double rate_beyond(const BoxGrowth& growth, const Motion& motion);

/// Gives each pore its part by volume of what the container grows by: all cells have grown alike.
void spread_over_pores(double rate, const BuiltNetwork& built, Eigen::VectorXd& rates);

/// The transpose of both: load on each face of the mean pressure on its growth, so that faces feel the pressures on
/// their present areas and the fluid does on them the work that they do on it.
Matrix6Xd forces_on_growth(const BoxGrowth& growth, const BuiltNetwork& built, const Eigen::VectorXd& pressures);

}  // namespace pfv
