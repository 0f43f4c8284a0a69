// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "step/problem.hpp"
#include "step/solution.hpp"
#include "work/work_record.hpp"

namespace pfv {

/// What a step is taken with.
struct StepTask {
  BuiltNetwork& built;
  const Problem& problem;
  const Packing& packing;
  const GrainDynamics* dynamics;  ///< null for explicit steps, which need none
  WorkRecord& work;
};

/// A way to find the pressures that act over a step. Each owns what it keeps from step to step.
class StepScheme {
 public:
  virtual ~StepScheme() = default;

  /// Throws InputError for settings that the scheme cannot serve.
  virtual void check(const Problem& problem) const = 0;
  /// Where the step lies whose mean velocities the packing has: 1 for one that begins now, -1 for one that
  /// has ended.
  virtual double direction() const = 0;
  /// Completes a solution that knows its box, time and step. Throws InputError, SolverError.
  virtual void find(const StepTask& task, Solution& solution) = 0;
  /// The network is another.
  virtual void forget_network() {}
  /// G has been factored anew on the same network.
  virtual void forget_factor() {}
};

/// Rates of the packing's velocities, as explicit steps and the first stage take them.
void find_rates_of_packing(const StepTask& task, Solution& solution);

/// Thesis eq. 4.8: the pressures that belong to the velocities given.
class ExplicitStep final : public StepScheme {
 public:
  void check(const Problem&) const override {}
  double direction() const override { return -1.0; }
  void find(const StepTask& task, Solution& solution) override;
};

}  // namespace pfv
