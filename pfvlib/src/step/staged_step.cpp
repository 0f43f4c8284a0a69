// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/staged_step.hpp"

#include "physics/chebyshev_stages.hpp"
#include "step/operators.hpp"
#include "step/pressure_solve.hpp"

#include <vector>

namespace pfv {

namespace {

/// A quantity carried through the recursion from zero: by linearity its mean over the step.
template <class Value>
struct Carried {
  Value mean, before;

  void take(const ChebyshevStage& stage, const Value& value) {
    Value next = stage.m * mean + stage.n * before + stage.f * value;
    before = std::move(mean);
    mean = std::move(next);
  }
};

/// Integrates m dv/dt = held + S p(v) over the step. The mean pressure, volume rates and motion are carried
/// along; they belong to the mean force, so that forces, fluxes and volumes of the step balance exactly.
void run_recursion(const StepTask& task, const ForcedMotion& forced,
                   const std::vector<ChebyshevStage>& recursion, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const Motion still = Motion::Zero(6, forced.start.cols());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(built.network.pores());
  Carried<Motion> motion{still, still};
  Carried<Eigen::VectorXd> pressure{none, none}, rates{none, none};
  Motion before = forced.start, now = forced.start;
  for (const ChebyshevStage& stage : recursion) {
    find_rates(built, problem, now, work, solution);
    solve_pressures(built, problem, *built.kept.solver, work, solution);
    Loads resisting = resisting_forces(built, problem.fluid.viscosity, now);
    join_loads(built, resisting);
    const Loads loads = pressure_loads(built, solution) + resisting;
    Motion next = (1.0 - stage.m - stage.n) * forced.start + stage.m * now + stage.n * before +
                  stage.f * (forced.moved_by(loads) - forced.start);
    if (built.share.ranks) built.share.spheres.refresh(*built.share.ranks, next);
    pressure.take(stage, solution.relative_pressures);
    rates.take(stage, solution.rates);
    motion.take(stage, now);
    before = std::move(now);
    now = std::move(next);
  }
  solution.motion = std::move(motion.mean);
  solution.relative_pressures = pressure.mean;
  solution.rates = rates.mean;
  solution.pressures = solution.relative_pressures.array() + solution.reference;
}

}  // namespace

void StagedStep::find(const StepTask& task, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  find_rates_of_packing(task, solution);
  check_dynamics(task);
  const double limit =
      limit_.of(built, problem, own_count(task), dynamics->masses, dynamics->pistons, dynamics->bodies, work);
  // z: the step times the largest eigenvalue of the drag
  const std::vector<ChebyshevStage> recursion = chebyshev_stages(2.0 * solution.dt / limit);
  solution.stages = static_cast<int>(recursion.size());
  if (recursion.size() == 1)
    return solve_pressures(built, problem, *built.kept.solver, work, solution);
  make_force_matrices(built, problem, work.counts);
  solution.relative_pressures.setZero(built.network.pores());
  impose(built, solution);  // the reference pressure acts on pistons
  const ForcedMotion forced{solution.motion, held_loads(task, solution),
                            yielding_of(built, problem, *dynamics, solution.dt), bodies_of(built)};
  solution.moving = true;
  run_recursion(task, forced, recursion, solution);
}

}  // namespace pfv
