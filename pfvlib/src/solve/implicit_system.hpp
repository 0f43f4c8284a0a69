// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/force_matrix.hpp"
#include "physics/rigid_bodies.hpp"
#include "physics/shear_forces.hpp"
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
/// B, dt over mass (s/kg) or inertia (s/(kg m²)) for each row of S, 0 for what no force moves. With rigid bodies
/// `forces` is that on them (physics/rigid_bodies.hpp).
ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns,
                                 const ForceMatrix& forces, const Bases& bases,
                                 const Matrix6Xd& yielding);

/// The same step where shear forces -R v join the velocities of neighbours: (M/dt + R)^-1 is full, so that what the
/// grains yield by stays unknown beside the pressures:
///
///     [ -(G + S_f^T B_f S_f)   -S^T     ] [p]   [-b]
///     [ -S                     M/dt + R ] [u] = [ f]
///
/// S_f, B_f: of the faces. Quasi-definite: L D L^T exists in any order.
struct ShearedSystem {
  struct Velocity {
    int mover, component;  ///< column and row of a (wide) motion: 0-2 velocity, 3-5 spin; no face
  };
  SymmetricMatrix matrix;
  std::vector<double> signs;  ///< of the pivots: -1 of the pressures, which come first, 1 of the velocities
  int pressures = 0;
  std::vector<Velocity> velocities;
  std::vector<Isolated> isolated;  ///< as of ImplicitSystem
  /// Pressures that nothing but grains determines: their pivots come after those of the grains.
  std::vector<int> last;
};

/// `pairs` and `viscosity`: R. `bodies`: those that `forces` acts on, or null.
ShearedSystem assemble_sheared(const PressureSystem& system, const Unknowns& unknowns, const ForceMatrix& forces,
                               const Bases& bases, const Matrix6Xd& yielding,
                               const std::vector<ShearPair>& pairs, double viscosity, const RigidBodies* bodies);

/// Of the faces alone, which stand between the spheres and so many bodies: what is eliminated from a sheared system.
Matrix6Xd of_faces(Matrix6Xd yielding, int spheres, int bodies);

}  // namespace pfv
