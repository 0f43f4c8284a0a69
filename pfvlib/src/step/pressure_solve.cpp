// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/pressure_solve.hpp"

#include "pfv/error.hpp"
#include "physics/cell_stretching.hpp"
#include "problem/solver_abilities.hpp"
#include "step/continuity.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"
#include "step/trapped_pores.hpp"
#include "work/phase_clock.hpp"

#include <cmath>

namespace pfv {

namespace {

/// The velocities of the spheres as the network holds them, which may be images of where the host has them: in a
/// periodic cell that stretches, those move by so much more.
void move_with_images(const BuiltNetwork& built, const Problem& problem, const Packing& packing, Motion& motion) {
  const Container& container = problem.container;
  const std::vector<int>& columns = built.grains.columns;
  for (int axis = 0; axis < 3; ++axis) {
    if (!container.periodic[axis]) continue;
    const double length = container.upper[axis] - container.lower[axis];
    const double stretching = container.faces[2 * axis + 1].velocity[axis] - container.faces[2 * axis].velocity[axis];
    for (std::size_t i = 0; i < columns.size() && stretching != 0.0; ++i) {
      const auto own = static_cast<Eigen::Index>(i);
      const double way = built.grains.spheres.centres(axis, own) - (packing.positions(axis, columns[i]) - container.lower[axis]);
      motion(axis, own) += std::round(way / length) * stretching;
    }
  }
}

}  // namespace

void set_motion(const BuiltNetwork& built, const Problem& problem, const Packing& packing,
                Motion& motion) {
  const std::vector<int>& columns = built.grains.columns;
  motion = no_motion(static_cast<Eigen::Index>(columns.size()), problem.container.face_count());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto own = motion.col(static_cast<Eigen::Index>(i));
    if (packing.velocities.cols() > 0) own.head<3>() = packing.velocities.col(columns[i]);
    if (problem.options.torques && packing.angular_velocities.cols() > 0)
      own.tail<3>() = packing.angular_velocities.col(columns[i]);
  }
  if (stretches(problem.container)) move_with_images(built, problem, packing, motion);
  set_faces(motion, problem.container, built.network.origin);
}

void find_rates(BuiltNetwork& built, const Problem& problem, const Motion& motion, WorkRecord& work,
                Solution& solution) {
  const PhaseClock clock(work.seconds.assemble);
  make_volume_rates(built, problem, work.counts);
  ++work.counts.volume_rate;
  rates_of(built, motion, *problem.team, solution.rates);
  spread_over_pores(rate_beyond(solution.growth, motion) + solution.debt_rate, built, solution.rates);
}

namespace {

/// Summed as differences: where all are equal, the mean is exact.
double mean_imposed(const BuiltNetwork& built, const Eigen::VectorXd& pressures) {
  const Share& share = built.share;
  double first = 0.0, sum = 0.0, count = 0.0;
  for (const int pore : built.unknowns.imposed_pores)
    if (share.owns_pore(pore)) {
      if (count == 0.0) first = pressures[pore];
      ++count;
    }
  if (share.ranks) {  // of the lowest rank that has one
    const bool is_first = share.is_lowest(count > 0.0);
    first = share.sum(is_first ? first : 0.0);
  }
  for (const int pore : built.unknowns.imposed_pores)
    if (share.owns_pore(pore)) sum += pressures[pore] - first;
  count = share.sum(count);
  return count > 0.0 ? first + share.sum(sum) / count : 0.0;
}

}  // namespace

void impose(const BuiltNetwork& built, Solution& solution) {
  const auto& pores = built.unknowns.imposed_pores;
  Eigen::VectorXd& relative = solution.relative_pressures;
  impose_pressures(built.network, built.boundaries, solution.container, solution.time, relative);
  solution.reference = mean_imposed(built, relative);
  for (const int pore : pores) relative[pore] -= solution.reference;
  for (const int pore : built.unknowns.enclosed_pores) relative[pore] = 0.0;
}

namespace {

/// What the unknown pressures have to drive away from each pore, m³/s: -dV/dt, V^f p_old / (K_f dt) of a compressible
/// fluid, what a macroscopic gradient drives.
Eigen::VectorXd sources_of(const BuiltNetwork& built, const Solution& solution) {
  Eigen::VectorXd sources = -solution.rates;
  if (built.kept.compressible())
    sources.array() +=
        built.kept.storage->array() * (solution.previous_pressures.array() - solution.reference);
  const Eigen::Vector3d& gradient = solution.container.pressure_gradient;
  if (!gradient.isZero(0.0))
    sources += gradient_sources(built, gradient);
  return sources;
}

}  // namespace

void find_right_side(const BuiltNetwork& built, Solution& solution) {
  solution.relative_pressures.resize(built.network.pores());
  impose(built, solution);
  right_hand_side(built.kept.system, built.unknowns, solution.container, sources_of(built, solution),
                  solution.relative_pressures, solution.right_side);
}

void take_unknown_pressures(const BuiltNetwork& built, const std::vector<Isolated>& isolated, const LinearSolver& solver,
                            Solution& solution) {
  const std::vector<int>& unknown = built.unknowns.of_pore;
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0)
      solution.relative_pressures[static_cast<Eigen::Index>(p)] = solution.unknown_pressures[unknown[p]];
  level_trapped_pores(built, isolated, solution);
  solution.pressures = solution.relative_pressures.array() + solution.reference;
  if (built.share.any(!solution.pressures.allFinite()))
    throw SolverError(solver.name() +
                      " returned pressures that are not finite; the conductances span too many "
                      "orders of magnitude or the imposed values are too large");
}

void solve_pressures(BuiltNetwork& built, const Problem& problem, LinearSolver& solver,
                     WorkRecord& work, Solution& solution) {
  const PhaseClock clock(work.seconds.solve);
  find_right_side(built, solution);
  if (has_unknowns(built)) {
    solver.solve(solution.right_side, solution.unknown_pressures);
    ++work.counts.solve;
  }
  take_unknown_pressures(built, built.kept.system.isolated, solver, solution);
  if (&solver == built.kept.solver.get())
    refine_pressures(built, problem, solver, built.kept.loses_digits, work, solution, [] {});
}

void refine_pressures(BuiltNetwork& built, const Problem& problem, LinearSolver& solver,
                      std::optional<bool>& loses_digits, WorkRecord& work, Solution& solution,
                      const std::function<void()>& follow) {
  // A dense packing of 40 000 spheres loses 1.5e-10: that is not worth a second solve at each step.
  constexpr double lost = 1e-9, exact = 1e-10, hopeless = 1e-6;
  constexpr int sweeps = 4;
  if (!has_unknowns(built) || is_iterative(problem.options.solver) ||
      problem.options.precision == Precision::mixed || !loses_digits.value_or(true))
    return;
  std::int64_t& solves = work.counts.correction_solve;
  double last = 0.0;
  std::optional<double> rounding;  // seldom needed
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Eigen::VectorXd correction =
        homogeneous_pressures(built, solver, continuity_defect(built, solution), solves);
    const double largest = largest_pressure(built, solution.relative_pressures);
    last = largest_pressure(built, correction);
    if (last > exact * largest) {
      if (!rounding) rounding = rounding_of_pressures(built, solution, solves);
      if (last <= *rounding) return;
    }
    if (!loses_digits) loses_digits = last > lost * largest;
    if (!*loses_digits || last <= exact * largest) return;
    solution.relative_pressures += correction;
    solution.pressures = solution.relative_pressures.array() + solution.reference;
    follow();
    last /= largest;
  }
  if (!(last <= hopeless)) throw too_far_apart(built, problem.fluid);
}

Loads pressure_loads(const BuiltNetwork& built, const Solution& solution) {
  Loads sum = loads_of(built, solution.relative_pressures);
  join_loads(built, sum);
  const Matrix6Xd growth = forces_on_growth(solution.growth, built, solution.relative_pressures);
  sum.rightCols(growth.cols()) += growth;
  return sum;
}

}  // namespace pfv
