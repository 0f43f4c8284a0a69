// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/problem.hpp"
#include "step/solution.hpp"
#include "work/work_record.hpp"

#include <functional>
#include <optional>

namespace pfv {

// From volume rates to pressures, on a factor that is there. What is solved stands in the solution.

/// Fills in the velocities of the active grains and of the faces.
void set_motion(const BuiltNetwork& built, const Problem& problem, const Packing& packing,
                Motion& motion);

/// dV/dt of `motion`, which add up to that of the box as it is now, and what is owed.
void find_rates(BuiltNetwork& built, const Problem& problem, const Motion& motion, WorkRecord& work,
                Solution& solution);

/// Fills in the imposed pressures, less their mean: with a large common pressure the balances would
/// lose its digits.
void impose(const BuiltNetwork& built, Solution& solution);

/// b of G p = b for the rates of the solution, with its imposed pressures.
void find_right_side(const BuiltNetwork& built, Solution& solution);
/// The pressures of all pores from those of the unknowns, trapped ones levelled; `isolated`: the sets that pins hold.
/// Throws SolverError, `solver` by name, where one is not finite.
void take_unknown_pressures(const BuiltNetwork& built, const std::vector<Isolated>& isolated, const LinearSolver& solver,
                            Solution& solution);

/// Pressures for the rates of the solution. Throws SolverError.
void solve_pressures(BuiltNetwork& built, const Problem& problem, LinearSolver& solver,
                     WorkRecord& work, Solution& solution);

/// Where conductances lie so far apart that a solve on a factor loses digits of the pressures
/// (found out by the first solve on it): iterative refinement with the continuity defect, which
/// keeps them. Throws SolverError where that does not converge. `follow` brings up to date what follows
/// from the pressures in the same step. Cost: none on a factor that keeps its digits, else a solve or more.
void refine_pressures(BuiltNetwork& built, const Problem& problem, LinearSolver& solver,
                      std::optional<bool>& loses_digits, WorkRecord& work, Solution& solution,
                      const std::function<void()>& follow);

/// S p and the pressures on the faces as they are now, N and N m.
Loads pressure_loads(const BuiltNetwork& built, const Solution& solution);

}  // namespace pfv
