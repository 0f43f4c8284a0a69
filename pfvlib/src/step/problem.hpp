// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

  bool lifts() const { return options.buoyancy && !fluid.gravity.isZero(0.0); }
};

}  // namespace pfv
