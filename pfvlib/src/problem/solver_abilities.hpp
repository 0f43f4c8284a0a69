// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/options.hpp"

#include <string>

namespace pfv {

/// Of a solver, `automatic` among them. Throws InputError for one that options.hpp does not name.
const SolverAbilities& abilities_of(SolverKind solver);

/// Whether this build has it.
bool is_built(SolverKind solver);

/// "amg, cg or gauss_seidel": the solvers of this build with an ability, for messages and tables.
std::string solvers_with(bool SolverAbilities::*ability);

/// Throws InputError for a solver that this build lacks and for an ordering that the solver does not take.
void check(SolverKind solver, OrderingKind ordering);

/// What `automatic` stands for where the places of the unknowns are given.
SolverKind resolved(SolverKind solver);
OrderingKind resolved(SolverKind solver, OrderingKind ordering);

bool is_iterative(SolverKind solver);

/// Where the iterative solvers end if no tolerance is said, for tables: "1e-08 (amg), 1e-10 (cg, gauss_seidel)".
std::string own_tolerances();

/// Which code ordered, analysed, factored and solved, in one line.
std::string made_of(SolverKind solver, OrderingKind ordering);

}  // namespace pfv
