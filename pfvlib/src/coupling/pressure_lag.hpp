// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace pfv {

/// The pressures that long steps take for the correction (S - E^T) p before they know their own:
/// those of the last steps and their trend, by exponential smoothing of first and second order
/// (R. G. Brown, Smoothing, Forecasting and Prediction of Discrete Time Series, 1963), so that
/// pressures which change evenly are met exactly. All relative to the reference, Pa.
struct PressureLag {
  Eigen::VectorXd level;    ///< of the pressures, smoothed; empty before the first long step
  Eigen::VectorXd delayed;  ///< the level, smoothed once more, at the step before; like `level`
  double relaxation = 1.0;  ///< part of the way that both go in a step, in (0, 1]
  double trend = 1.0;       ///< part of the trend that is expected to go on, in (0, 1]

  /// Up to `prompt_limits` limits of the explicit coupling in a step (`limits`: the step over the limit)
  /// the correction follows at once. In a few motions the papers' S feeds energy to the grains, at a rate
  /// in proportion to 1/limit, so that at many limits a step it outgrows the contacts that hide it.
  /// Behind by some steps, it acts on them like an added mass and the feeding is slower. All other
  /// motions feel that mass, too: the trend takes it away, where there is little feeding to be feared.
  void relax(double limits, double prompt_limits);
  /// Of the step to come.
  Eigen::VectorXd expected() const;
  /// Takes in the pressures of the step that has ended.
  void follow(const Eigen::VectorXd& pressures);
  void start_from(const Eigen::VectorXd& pressures) { level = delayed = pressures; }
  bool empty() const { return level.size() == 0; }
  void forget();
};

}  // namespace pfv
