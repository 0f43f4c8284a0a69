// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/options.hpp"

#include <string>

namespace pfv {

/// What a solver is made of and what it can do: the one place that says so. Every check of the options
/// and every error about them reads it; how solvers work is the business of solve/.
struct SolverAbilities {
  SolverKind solver;
  bool is_built;              ///< whether this build has it
  const char* analysed;       ///< the code that makes the symbolic factorisation; null: there is none
  const char* factored;       ///< the code of the numeric factorisation, or of the preconditioner
  const char* solved;         ///< the code of the triangular solves, or of the iterations
  OrderingKind own_ordering;  ///< what `automatic` stands for; `automatic`: it tells nobody
  bool takes_orderings;       ///< geometric, metis and amd; if not, its own at most
  bool shares_work;           ///< threads share factorisation and solves
  bool factors_beside_steps;  ///< networks may be rebuilt in the background
  bool mixed_precision;
  bool implicit_steps;  ///< solves the matrix of implicit steps, which is quasi-definite
  bool is_iterative;    ///< ends at a tolerance
  double tolerance;     ///< where an iterative solver ends where none is said; 0 for the others
};

/// Of a solver, `automatic` among them. Throws InputError for one that options.hpp does not name.
const SolverAbilities& abilities_of(SolverKind solver);

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
