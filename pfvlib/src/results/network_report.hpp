// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "results/balance.hpp"
#include "step/fluid_memory.hpp"

namespace pfv {

/// What network, solution and its balance tell: all of a report but the packing, the fluid's account and the
/// work done. Cost: the first time after a triangulation, the exact union of the spheres; permeability tensors
/// (add_permeability).
Report network_report(BuiltNetwork& built, const Problem& problem, const Solution& solution,
                      const Balance& balance, std::int64_t& solves);

/// Where the fluid is.
void add_account(Report& report, const FluidMemory& memory, const BuiltNetwork& built,
                 const Fluid& fluid, const Solution& solution);

}  // namespace pfv
