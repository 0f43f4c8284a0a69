// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/implicit_solve.hpp"

#include "pfv/error.hpp"
#include "solve/linear_solver.hpp"
#include "step/continuity.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"
#include "step/pressure_solve.hpp"
#include "step/solvability.hpp"
#include "work/phase_clock.hpp"

#include <utility>

namespace pfv {

void ImplicitSolve::forget_factor() {
  if (factor_) factor_->yielding.resize(6, 0);
}

double ImplicitSolve::residual() const {
  return relative_residual(factor_->system.matrix, factor_->unknowns, factor_->right_side);
}

namespace {

/// Of the unknown pressures, then of what has unknown velocities; a body stands at one of its spheres.
Eigen::Matrix3Xd places_of(const BuiltNetwork& built, const ImplicitSystem& system) {
  Eigen::Matrix3Xd places(3, system.matrix.size());
  places.leftCols(system.pressures) = unknown_places(built);
  Eigen::Index place = system.pressures;
  const auto& centres = built.grains.spheres.centres;
  const RigidBodies* const bodies = bodies_of(built);
  std::vector<int> sphere_of(bodies ? bodies->count() : 0, 0);
  for (std::size_t m = 0; bodies && m < bodies->members.size(); ++m)
    sphere_of[bodies->members[m].body] = bodies->members[m].sphere;
  for (const auto& [mover, component] : system.velocities)
    places.col(place++) = centres.col(mover < centres.cols() ? mover : sphere_of[mover - bodies->first]);
  return places;
}

/// One entry for each velocity among the unknowns.
Eigen::VectorXd velocities_in(const ImplicitSystem& system, const Matrix6Xd& all) {
  Eigen::VectorXd own(static_cast<Eigen::Index>(system.velocities.size()));
  Eigen::Index row = 0;
  for (const auto& [mover, component] : system.velocities) own[row++] = all(component, mover);
  return own;
}

}  // namespace

void ImplicitSolve::order(const StepTask& task) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const PhaseClock clock(work.seconds.order);
  if (!factor_->solver)
    factor_->solver = std::make_unique<QuasiDefiniteSolver>(problem.options.ordering, problem.team);
  factor_->solver->describe(factor_->system.signs, factor_->system.last);
  factor_->solver->order(factor_->system.matrix, places_of(built, factor_->system));
  ++work.counts.order;
}

void ImplicitSolve::factor(const StepTask& task, Matrix6Xd yielding) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const int spheres = built.grains.spheres.size();
  if (!problem.options.torques) yielding.bottomLeftCorner(3, spheres).setZero();
  if (!factor_) factor_.emplace();
  const bool kept = factor_->yielding.cols() == yielding.cols() && factor_->yielding == yielding &&
                    factor_->still_water == built.operators.still_water;
  if (factor_->solver && kept) return;
  forget_factor();  // whatever goes wrong from here on
  const SymmetricMatrix old = std::move(factor_->system.matrix);
  const std::vector<int> old_last = std::move(factor_->system.last);
  {
    const PhaseClock clock(work.seconds.assemble);
    const ForceMatrix& forces = *built.operators.force_matrix;
    const RigidBodies* const bodies = bodies_of(built);
    factor_->system = assemble_implicit(built.kept.system, built.unknowns,
                                        bodies ? forces_on_bodies(forces, *bodies) : forces, built.bases, yielding,
                                        resistance_blocks(built, problem.fluid.viscosity), bodies);
  }
  const ImplicitSystem& system = factor_->system;
  if (!factor_->solver || system.matrix.row_begin != old.row_begin || system.matrix.column != old.column ||
      system.last != old_last)
    order(task);
  const PhaseClock clock(work.seconds.factor);
  try {
    factor_->solver->factor(system.matrix);
  } catch (const SolverError& error) {
    factor_.reset();
    throw too_far_apart(built, problem.fluid, error.what());
  }
  ++work.counts.factor;
  factor_->yielding = std::move(yielding);
  factor_->still_water = built.operators.still_water;
  factor_->loses_digits.reset();
}

/// Motion and rates of the unknowns as they are, and the loads that the motion has to answer, those of shear among
/// them; wide.
Loads ImplicitSolve::follow(const StepTask& task, const ForcedMotion& forced, double growth,
                            Solution& solution) const {
  const auto& [built, problem, packing, dynamics, work] = task;
  const ImplicitSystem& system = factor_->system;
  const int spheres = built.grains.spheres.size();
  const Loads pressures = pressure_loads(built, solution);
  const int count = forced.bodies ? forced.bodies->count() : 0;
  const ForcedMotion faces{forced.start, forced.held, of_faces(factor_->yielding, spheres, count), forced.bodies};
  solution.motion = faces.moved_by(pressures);
  Motion gained = no_motion(solution.motion.cols(), count);
  Eigen::Index row = system.pressures;
  for (const auto& [mover, component] : system.velocities) gained(component, mover) += factor_->unknowns[row++];
  solution.motion += forced.bodies ? forced.bodies->spread(gained) : gained;
  rates_of(built, solution.motion, *problem.team, solution.rates);
  spread_over_pores(growth, built, solution.rates);
  // K has no R of faces: for it they go on as they did
  Motion for_grains = solution.motion;
  const int moving_faces = problem.container.face_count();
  for_grains.middleCols(spheres, moving_faces) = forced.start.middleCols(spheres, moving_faces);
  const Loads resisting = resisting_forces(built, problem.fluid.viscosity, for_grains);
  return forced.bodies ? forced.all(pressures + resisting) : Loads(forced.held + pressures + resisting);
}

/// As refine_pressures: the defects of continuity and of the balance of forces drive a correction of both.
void ImplicitSolve::refine(const StepTask& task, const ForcedMotion& forced, double growth, Loads loads,
                           Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  constexpr double lost = 1e-9, exact = 1e-10, hopeless = 1e-6;
  constexpr int sweeps = 4;
  const ImplicitSystem& system = factor_->system;
  if (system.matrix.size() == 0 || !factor_->loses_digits.value_or(true)) return;
  const Eigen::VectorXd inverse = velocities_in(system, factor_->yielding).cwiseInverse();
  double last = 0.0;
  std::optional<double> rounding;  // seldom needed
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Eigen::VectorXd defect = continuity_defect(built, solution);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(system.matrix.size()), correction = b;
    for (std::size_t p = 0; p < built.unknowns.of_pore.size(); ++p)
      if (const int unknown = built.unknowns.of_pore[p]; unknown >= 0)
        b[unknown] -= defect[static_cast<Eigen::Index>(p)];
    auto velocities = b.tail(b.size() - system.pressures);
    velocities = velocities_in(system, loads) -
                 inverse.cwiseProduct(factor_->unknowns.tail(velocities.size()));
    factor_->solver->solve(b, correction);
    ++work.counts.correction_solve;
    const double largest = solution.relative_pressures.cwiseAbs().maxCoeff();
    last = correction.head(system.pressures).lpNorm<Eigen::Infinity>();
    if (last > exact * largest) {
      if (!rounding) rounding = rounding_of_pressures(built, solution, work.counts.correction_solve);
      if (last <= *rounding) return;
    }
    if (!factor_->loses_digits) factor_->loses_digits = last > lost * largest;
    if (!*factor_->loses_digits || last <= exact * largest) return;
    factor_->unknowns += correction;
    solution.unknown_pressures = factor_->unknowns.head(system.pressures);
    take_unknown_pressures(built, isolated(), *factor_->solver, solution);
    loads = follow(task, forced, growth, solution);
    last /= largest;
  }
  if (!(last <= hopeless)) throw too_far_apart(built, problem.fluid);
}

/// What the box has grown by is taken with the velocities that faces have by the other forces, as in ImplicitStep.
void ImplicitSolve::solve(const StepTask& task, const ForcedMotion& forced, Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const ImplicitSystem& system = factor_->system;
  const Eigen::Index pressures = system.pressures, size = system.matrix.size();
  const Loads imposed = pressure_loads(built, solution);
  const Motion faces = forced.moved_by(imposed);
  const double growth = rate_beyond(solution.growth, faces) + solution.debt_rate;
  ++work.counts.volume_rate;
  {
    const PhaseClock clock(work.seconds.solve);
    factor_->unknowns.setZero(size);
    const Loads known = follow(task, forced, growth, solution);  // by what is imposed, and the start
    find_right_side(built, solution);
    factor_->right_side.resize(size);
    factor_->right_side << -solution.right_side, velocities_in(system, known);
    if (size > 0) {
      factor_->solver->solve(factor_->right_side, factor_->unknowns);
      ++work.counts.solve;
    }
    solution.unknown_pressures = factor_->unknowns.head(pressures);
    take_unknown_pressures(built, isolated(), *factor_->solver, solution);
  }
  refine(task, forced, growth, follow(task, forced, growth, solution), solution);
  solution.unpaid = solution.dt * (rate_beyond(solution.growth, solution.motion) -
                                   rate_beyond(solution.growth, faces));
}

}  // namespace pfv
