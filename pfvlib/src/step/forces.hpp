// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "step/problem.hpp"
#include "step/solution.hpp"
#include "work/work_record.hpp"

namespace pfv {

/// Buoyancy -density V gravity, N; `column` of the packing.
Eigen::Vector3d lift_of(const Problem& problem, const Packing& packing, int column);

/// F = S p of the solution's pressures and what the options add to it; fills in the solution's loads, too.
/// Cost: a pass over S.
void find_forces(BuiltNetwork& built, const Problem& problem, const Packing& packing,
                 WorkRecord& work, Solution& solution, Forces& forces);

/// Force on each face; the fluxes are left 0.
std::vector<FaceResult> face_forces(const BuiltNetwork& built, const Solution& solution);

}  // namespace pfv
