// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/force_matrix.hpp"
#include "physics/volume_rates.hpp"
#include "solve/linear_solver.hpp"
#include "solve/pressure_system.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// A = G + S^T B S, symmetric positive definite: pressures that know how the grains yield to them
/// within a time step. The pattern joins all pores around a sphere, or on a face, that yields: 60 to 80
/// entries a row.
struct ImplicitSystem {
  SymmetricMatrix matrix;
  /// Sets of pores without a way to a pressure that are still held at the reference pressure. One that
  /// can push a yielding grain away needs none: its pressure is what keeps its volume.
  std::vector<Isolated> isolated;
};

/// `system`: G with storage. `forces`: S, to which the pressures on the faces come. `yielding`: the diagonal of
/// B, dt over mass (s/kg) or inertia (s/(kg m²)) for each row of S, 0 for what no force moves.
ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns,
                                 const ForceMatrix& forces, const Bases& bases,
                                 const Matrix6Xd& yielding);

}  // namespace pfv
