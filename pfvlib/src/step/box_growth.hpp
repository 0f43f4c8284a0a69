// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "physics/rigid_motion.hpp"
#include "step/built_network.hpp"

namespace pfv {

// A network is kept while the box changes: volumes and forces that follow the box as it is.

/// What each face has grown by since the network was built, m²: until the middle of the step that the
/// velocities belong to, and until now. With the areas of the middle the faces sweep just what the box's
/// volume changes by.
struct BoxGrowth {
  Eigen::VectorXd in_the_middle, now;
};
/// `ahead`, s: from now to that middle.
BoxGrowth growth_of(const Box& box, const Eigen::Vector3d& edges_as_built, double ahead);

/// What the box grows by beyond the rates of the network as it was built, m³/s.
double rate_beyond(const BoxGrowth& growth, const Motion& motion);

/// Gives each pore its part by volume of what the box grows by: all cells have grown alike.
void spread_over_pores(double rate, const Throats& throats, Eigen::VectorXd& rates);

/// The transpose of both: force on each face, along its outward normal, of the mean pressure on its growth, N,
/// so that faces feel the pressures on their present areas and the fluid does on them the work that they do on
/// it.
Eigen::VectorXd forces_on_growth(const BoxGrowth& growth, const Throats& throats,
                                 const Eigen::VectorXd& pressures);

}  // namespace pfv
