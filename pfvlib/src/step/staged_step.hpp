// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/long_step.hpp"
#include "step/time_step_limit.hpp"

namespace pfv {

/// The drag is integrated over the step in Chebyshev sub-stages on the kept factor, the other forces held;
/// below the limit of the explicit step it is that. Verwer 1996, first-order RKC.
class StagedStep final : public StepScheme {
 public:
  /// `limit`: of the explicit step, kept for the same network; must outlive this.
  explicit StagedStep(TimeStepLimit& limit) : limit_(limit) {}

  void check(const Problem& problem) const override { check_long_step(problem, Coupling::staged); }
  double direction() const override { return 1.0; }
  void find(const StepTask& task, Solution& solution) override;

 private:
  TimeStepLimit& limit_;
};

}  // namespace pfv
