// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/step_scheme.hpp"

namespace pfv {

// What staged and implicit steps share: the motion that they integrate.

/// A column for each active sphere and each face.
struct ForcedMotion {
  Motion start;
  Loads held;          ///< all but those of the pressures less their reference
  Matrix6Xd yielding;  ///< dt over mass, s/kg, or over inertia, s/(kg m²); 0 for what no force moves

  Motion moved_by(const Loads& loads) const {
    return start + (yielding.array() * (held + loads).array()).matrix();
  }
};

/// Throws InputError for settings that no long step can serve.
void check_long_step(const Problem& problem, Coupling coupling);
/// Throws InputError for masses and forces that are missing or make no sense.
void check_dynamics(const GrainDynamics& dynamics, const Packing& packing, const Container& container);

/// Of the active grains and the faces, which yield along their axes alone; 0 for a prescribed velocity.
/// The axis along which a piston is guided. Throws InputError where it is none of x, y, z.
int guided_axis(const Container& container, int face);
Matrix6Xd yielding_of(const BuiltNetwork& built, const Problem& problem, const GrainDynamics& dynamics,
                      double step);

/// All loads on the active grains and the pistons but those of the pressures less their reference.
Loads held_loads(const StepTask& task, const Solution& solution);

}  // namespace pfv
