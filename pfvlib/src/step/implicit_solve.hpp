// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/implicit_system.hpp"
#include "solve/quasi_definite_solver.hpp"
#include "step/long_step.hpp"

#include <memory>
#include <optional>

namespace pfv {

/// Pressures and velocities of an implicit step, found together by one solve; -R u: shear forces and drag in open
/// water, where there are any:
///
///     (M/(theta dt)) (u - w) = held + S p - R u,      G p = Q - S^T u
///
/// Keeps the factor until the network, a mass, theta dt or R changes.
class ImplicitSolve {
 public:
  void forget_network() { factor_.reset(); }
  void forget_factor();
  /// Anew where `yielding`, theta dt over masses, or R has changed. Throws SolverError.
  void factor(const StepTask& task, Matrix6Xd yielding);
  /// Completes the solution, whose imposed pressures are in it. `forced`: the motion to set out from and all
  /// forces but those of the unknown pressures and of R.
  void solve(const StepTask& task, const ForcedMotion& forced, Solution& solution);

  /// Sets of pores that are still held at the reference pressure.
  const std::vector<Isolated>& isolated() const { return factor_->system.isolated; }
  /// |b - K x| / |b| of the last solve.
  double residual() const;

 private:
  struct Factor {
    ImplicitSystem system;
    std::unique_ptr<QuasiDefiniteSolver> solver;
    std::optional<bool> loses_digits;  ///< as of KeptSystem
    Matrix6Xd yielding;                ///< that is in the factor; no columns: none is
    bool still_water = true;           ///< whose R is (KeptOperators)
    Eigen::VectorXd right_side, unknowns;  ///< of the last solve: pressures, then velocities less those at the start
  };
  std::optional<Factor> factor_;

  void order(const StepTask& task);
  Loads follow(const StepTask& task, const ForcedMotion& forced, double growth, Solution& solution) const;
  void refine(const StepTask& task, const ForcedMotion& forced, double growth, Loads loads, Solution& solution);
};

}  // namespace pfv
