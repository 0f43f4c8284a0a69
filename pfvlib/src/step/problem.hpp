// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "parallel/team.hpp"
#include "pfv/container.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"

#include <memory>

namespace pfv {

/// The problem as it is posed now, and who shares the work. All that a network depends on beside the grains.
struct Problem {
  const Container& container;
  const Fluid& fluid;
  const Options& options;
  const std::shared_ptr<Team>& team;
  std::shared_ptr<const Ranks> ranks = nullptr;  ///< that share the packing; null: one has it

  bool lifts() const { return options.buoyancy && !fluid.gravity.isZero(0.0); }
};

}  // namespace pfv
