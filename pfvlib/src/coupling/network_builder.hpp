// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"
#include "coupling/built_network.hpp"
#include "pfv/fluid.hpp"
#include "pfv/report.hpp"

#include <memory>
#include <string>

namespace pfv {

/// All that a network depends on beside the grains.
struct BuildSettings {
  const Box& box;
  const Fluid& fluid;
  const Options& options;
  const std::shared_ptr<Team>& team;  ///< which will share the solves
};

/// What building has taken.
struct BuildCost {
  Counts& counts;
  Seconds& seconds;
};

// Pure functions, but for the cost: they may run beside anything that does not touch the same
// network.

/// From the grains to the conductances. Throws InputError for a bad packing.
std::unique_ptr<BuiltNetwork> derive_network(const Packing& packing, const BuildSettings& settings,
                                             BuildCost cost);

/// G with the storage of a time step `step` (s), ordered, where it has not been, and factored. Does
/// nothing where it is there already. Throws SolverError.
void factor_pressures(BuiltNetwork& built, const BuildSettings& settings, double step,
                      BuildCost cost);

/// S, where it is not there yet.
void make_force_matrix(BuiltNetwork& built, const Options& options, Team& team, Counts& counts);

/// What volume rates need, likewise: S, or E where the options want that.
void make_volume_rates(BuiltNetwork& built, const Options& options, Team& team, Counts& counts);

/// S and what the options want of the forces beside.
void make_force_matrices(BuiltNetwork& built, const Options& options, Team& team, Counts& counts);

/// Why a network cannot be factored: where its conductances are the smallest and the largest.
SolverError too_far_apart(const BuiltNetwork& built, const Fluid& fluid,
                          const std::string& reason = {});

}  // namespace pfv
