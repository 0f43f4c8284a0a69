// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/force_matrix.hpp"
#include "solve/linear_solver.hpp"
#include "solve/pressure_system.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// A = G + E B E^T, symmetric positive definite: pressures that know how the grains yield to them
/// within a time step. The pattern joins all pores around a sphere, or on a face, that yields: 60 to 80
/// entries a row.
struct ImplicitSystem {
  SymmetricMatrix matrix;
  /// Sets of pores without a way to a pressure that are still held at the reference pressure. One that
  /// can push a yielding grain away needs none: its pressure is what keeps its volume.
  std::vector<Isolated> isolated;
};

/// `system`: G with storage. `energy_forces`: E^T. `yielding`: the diagonal of B, dt/m (s/kg) of each
/// row of E^T, 0 for what no force moves.
ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns,
                                 const ForceMatrix& energy_forces,
                                 const Eigen::VectorXd& yielding);

}  // namespace pfv
