// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/step_scheme.hpp"

namespace pfv {

// What staged and implicit steps share: the motion that they integrate.

/// A column for each active sphere and each face; `held` and `yielding` have one for each rigid body behind them.
struct ForcedMotion {
  Motion start;
  Loads held;          ///< all but those of the pressures less their reference
  Matrix6Xd yielding;  ///< dt over mass, s/kg, or over inertia, s/(kg m²); 0 for what no force moves
  const RigidBodies* bodies;  ///< null: there are none

  /// These and the held ones, on what yields.
  Loads all(const Loads& loads) const;
  Motion moved_by(const Loads& loads) const;
};

/// Throws InputError for settings that no long step can serve.
void check_long_step(const Problem& problem, Coupling coupling);
/// The grains of this rank in the packing of a step, which come before its ghosts.
Eigen::Index own_count(const StepTask& task);
/// Throws InputError for masses and forces that are missing or make no sense.
void check_dynamics(const StepTask& task);

/// Throws InputError where these are not the bodies that hold this rank's spheres, or make no sense.
void check_bodies(const std::vector<RigidBody>& bodies, const BuiltNetwork& built);
/// Takes up how spheres go along with the bodies, once a network: the rows of S are those of its instant, too. Throws
/// InputError where ranks give different ones. Collective.
void take_bodies(BuiltNetwork& built, const Problem& problem, const std::vector<RigidBody>& bodies);
/// Those taken up, or null.
const RigidBodies* bodies_of(const BuiltNetwork& built);
/// `step` (s) over mass and inertia, one column a body.
Matrix6Xd yielding_of_bodies(const std::vector<RigidBody>& bodies, double step);

/// The axis along which a piston is guided. Throws InputError where it is none of x, y, z.
int guided_axis(const Container& container, int face);
/// Of the active grains and the faces, which yield along their axes alone, and of the bodies taken up; 0 for a
/// prescribed velocity.
Matrix6Xd yielding_of(const BuiltNetwork& built, const Problem& problem, const GrainDynamics& dynamics,
                      double step);

/// All loads on the active grains, the pistons and the bodies but those of the pressures less their reference.
Loads held_loads(const StepTask& task, const Solution& solution);

}  // namespace pfv
