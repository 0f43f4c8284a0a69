// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"
#include "pfv/packing.hpp"
#include "step/built_network.hpp"
#include "step/problem.hpp"
#include "work/work_record.hpp"

#include <memory>
#include <string>

namespace pfv {

// Pure functions, but for the record of work: they may run beside anything that does not touch the same
// network.

/// From the grains to the conductances. Throws InputError for a bad packing.
std::unique_ptr<BuiltNetwork> derive_network(const Packing& packing, const Problem& problem,
                                             WorkRecord& work);

/// Whether factor_pressures has something to do.
bool is_unfactored(const BuiltNetwork& built, const Fluid& fluid, double step);

/// G with the storage V^f / (K_f dt) of a time step `step` (s) on its diagonal, ordered, where it has not been, and
/// factored. Does nothing, and returns false, where it is there already. Throws SolverError.
bool factor_pressures(BuiltNetwork& built, const Problem& problem, double step, WorkRecord& work);

/// Why a network cannot be factored: where its conductances are the smallest and the largest.
SolverError too_far_apart(const BuiltNetwork& built, const Fluid& fluid,
                          const std::string& reason = {});

}  // namespace pfv
