// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/long_step.hpp"
#include "step/implicit_solve.hpp"

namespace pfv {

/// Pressures and the velocities that follow from them are found together: the theta method in the drag.
class ImplicitStep final : public StepScheme {
 public:
  void check(const Problem& problem) const override;
  double direction() const override { return 1.0; }
  void find(const StepTask& task, Solution& solution) override;
  void forget_network() override { joint_.forget_network(); }
  void forget_factor() override { joint_.forget_factor(); }

  /// |b - K x| / |b| of the last solve.
  double residual() const { return joint_.residual(); }

 private:
  ImplicitSolve joint_;
};

}  // namespace pfv
