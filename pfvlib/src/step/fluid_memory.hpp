// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/fluid_account.hpp"
#include "step/network_keeper.hpp"
#include "step/solution.hpp"

#include <vector>

namespace pfv {

/// What the fluid remembers from one step to the next.
struct FluidMemory {
  double time = 0.0;  ///< s, that was advanced
  /// Of the present pores at the last step, Pa; none but for a compressible fluid.
  Eigen::VectorXd pressures;
  bool pressed = false;  ///< there are some, on any rank
  /// Pressures of a restart, for the network that the next packing gives; of several ranks' those of the first count.
  std::vector<double> restored;
  FluidAccount account;
  double volume_debt = 0.0;  ///< what the box has grown by beyond the rates of implicit steps, m³

  bool is_restored(const Share& share) const { return share.any(!restored.empty()); }
};

/// Takes the memory to a new network: pressures of a compressible fluid, and the account. Grains that came or
/// went have pushed fluid out or let it in, and a host that asks for a new network has put grains and faces
/// elsewhere: that is flow. All else by which the space has changed beyond the volume rates - grains that grew,
/// what implicit steps left - a compressible fluid takes up: it is compressed. `swept`: by the faces in a step
/// that has ended and is not in the account yet, m³.
void carry_over(FluidMemory& memory, const Replaced& before, const BuiltNetwork& now,
                const Problem& problem, double swept);

/// Volume of the fluid in a box of `volume` around the grains of all ranks, m³.
double space_around(const BuiltNetwork& built, double volume);

/// What the faces have swept in a step that has just ended, m³.
double swept_volume(const Container& container, double step);

/// Books a step that has been taken.
void remember(FluidMemory& memory, const BuiltNetwork& built, const Fluid& fluid,
              const Solution& solution);

/// What is in the box beyond what was at the start and came in, m³: 0 but for what the volume rates do
/// not know of.
double fluid_missing(const FluidMemory& memory, const BuiltNetwork& built, const Fluid& fluid,
                     const Container& container);

}  // namespace pfv
