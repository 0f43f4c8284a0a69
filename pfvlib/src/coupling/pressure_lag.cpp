// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/pressure_lag.hpp"

#include <algorithm>

namespace pfv {

void PressureLag::relax(double limits) {
  constexpr double prompt_limits = 30.0;
  relaxation = std::min(1.0, prompt_limits / limits);
}

Eigen::VectorXd PressureLag::expected() const {
  return level + relaxation * relaxation * (level - delayed);
}

void PressureLag::follow(const Eigen::VectorXd& pressures) {
  delayed += relaxation * (level - delayed);
  level += relaxation * (pressures - level);
}

void PressureLag::forget() {
  level.resize(0);
  delayed.resize(0);
}

}  // namespace pfv
