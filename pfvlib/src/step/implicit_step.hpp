// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/implicit_system.hpp"
#include "step/long_step.hpp"
#include "step/sheared_implicit.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace pfv {

/// Pressures and the velocities that follow from them are found together: the theta method in the drag.
class ImplicitStep final : public StepScheme {
 public:
  void check(const Problem& problem) const override;
  double direction() const override { return 1.0; }
  void find(const StepTask& task, Solution& solution) override;
  void forget_network() override;
  void forget_factor() override;

  /// |b - A x| / |b| of the last solve, A = G + theta S^T (dt/m) S.
  double residual(const Solution& solution) const;

 private:
  struct Factor {
    ImplicitSystem system;
    std::unique_ptr<LinearSolver> solver;
    std::optional<bool> loses_digits;  ///< as of KeptSystem
    Matrix6Xd yielding;  ///< of the grains and faces whose A is in the factor; no columns: none is
  };
  std::optional<Factor> factor_;
  ShearedImplicit sheared_;  ///< where there are shear forces

  void factor(const StepTask& task, const Matrix6Xd& yielding);
  void solve(const StepTask& task, const ForcedMotion& forced, Solution& solution);
};

}  // namespace pfv
