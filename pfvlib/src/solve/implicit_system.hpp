// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/force_matrix.hpp"
#include "physics/resistance.hpp"
#include "physics/rigid_bodies.hpp"
#include "physics/volume_rates.hpp"
#include "solve/linear_solver.hpp"
#include "solve/pressure_system.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Pressures p and what the velocities of the grains gain in a time step, u, found together:
///
///     [ -(G + S_f^T B_f S_f)   -S^T     ] [p]   [-b]
///     [ -S                     M/dt + R ] [u] = [ f]
///
/// R: of forces -R v, shear and drag in open water, which join the velocities of neighbours. S_f, B_f: of the faces,
/// which are eliminated.
/// Quasi-definite: L D L^T exists in any order. Grains could be eliminated as well where there is no R, which
/// leaves G + S^T B S; but that joins all pores around a sphere, and its factor has 1.4 times as many entries.
struct ImplicitSystem {
  struct Velocity {
    int mover, component;  ///< column and row of a (wide) motion: 0-2 velocity, 3-5 spin; no face
  };
  SymmetricMatrix matrix;
  std::vector<double> signs;  ///< of the pivots: -1 of the pressures, which come first, 1 of the velocities
  int pressures = 0;
  std::vector<Velocity> velocities;
  /// Sets of pores without a way to a pressure that are still held at the reference pressure. One that
  /// can push a yielding grain away needs none: its pressure is what keeps its volume.
  std::vector<Isolated> isolated;
  /// Pressures that nothing but grains determines: their pivots come after those of the grains.
  std::vector<int> last;
};

/// `system`: G with storage. `forces`: S, to which the pressures on the faces come; with rigid bodies that on them
/// (physics/rigid_bodies.hpp), and `bodies` these, else null. `yielding`: the diagonal of B, dt over mass (s/kg) or
/// inertia (s/(kg m²)) for each row of S, 0 for what no force moves. `resistance`: R, among spheres.
ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns, const ForceMatrix& forces,
                                 const Bases& bases, const Matrix6Xd& yielding,
                                 const std::vector<ResistanceBlock>& resistance, const RigidBodies* bodies);

/// Of the faces alone, which stand between the spheres and so many bodies: what is eliminated.
Matrix6Xd of_faces(Matrix6Xd yielding, int spheres, int bodies);

}  // namespace pfv
