// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/pressure_lag.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

void PressureLag::relax(double limits, double prompt_limits) {
  constexpr double even_limits = 20.0;  // up to which the trend is taken in full
  relaxation = std::min(1.0, prompt_limits / limits);
  trend = std::pow(std::min(1.0, even_limits / limits), 4);
}

Eigen::VectorXd PressureLag::expected() const {
  return level + trend * (level - delayed);
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
