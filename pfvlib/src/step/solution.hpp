// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"
#include "physics/rigid_motion.hpp"
#include "step/box_growth.hpp"

#include <Eigen/Core>

namespace pfv {

/// What one call has found, on the network that it was found on: a value, from which balances, averages,
/// permeability and fields follow. Arrays have one entry a pore where nothing else is said.
struct Solution {
  // what it is the solution of
  Container container;    ///< with the values at that instant
  ContainerGeometry geometry;  ///< of it, about the network's origin
  double time = 0.0;  ///< instant of the boundary values, s
  double dt = 0.0;    ///< of the step, s; 0: a steady state
  bool moving = false;
  bool implicit = false;  ///< grains yield within the step: the matrix is A, not G
  int stages = 1;
  Motion motion;          ///< that `rates` belong to; of a long step the mean over it
  BoxGrowth growth;       ///< since the network was built
  double debt_rate = 0.0; ///< m³/s at which volumes that former implicit steps left are made up for
  double unpaid = 0.0;    ///< m³ that this one leaves
  Eigen::VectorXd rates;  ///< dV/dt, m³/s
  Eigen::VectorXd previous_pressures;  ///< of a compressible fluid before the step, Pa

  // the solution
  double reference = 0.0;              ///< pressure that was subtracted before solving, Pa
  Eigen::VectorXd relative_pressures;  ///< minus the reference, Pa
  Eigen::VectorXd pressures;           ///< Pa
  Eigen::VectorXd right_side, unknown_pressures;  ///< of the unknowns
  Loads loads;  ///< S p; no columns where no forces are wanted
};

}  // namespace pfv
