// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/pressure_solve.hpp"
#include "step/solvability.hpp"
#include "step/step_scheme.hpp"

namespace pfv {

void find_rates_of_packing(const StepTask& task, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  solution.moving = built.share.any(!at_rest(packing, problem.container, problem.options.torques));
  refuse_undetermined(problem, solution.moving);
  set_motion(built, problem, packing, solution.motion);
  if (solution.moving)
    find_rates(built, problem, solution.motion, work, solution);
  else
    solution.rates.setZero(built.network.pores());
  refuse_isolated(built, solution, built.kept.system.isolated);
}

void ExplicitStep::find(const StepTask& task, Solution& solution) {
  find_rates_of_packing(task, solution);
  solve_pressures(task.built, task.problem, *task.built.kept.solver, task.work, solution);
}

}  // namespace pfv
