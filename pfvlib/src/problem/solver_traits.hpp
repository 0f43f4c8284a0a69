// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/options.hpp"

#include <string>

namespace pfv {

/// What settings have to know of a solver; how it works is the business of solve/.
struct SolverTraits {
  SolverKind kind;
  bool iterative;         ///< ends at a tolerance
  bool mixed_precision;   ///< can keep its factor in single precision
  bool background;        ///< can factor beside another thread that steps on
  bool takes_orderings;   ///< any of them
  OrderingKind ordering;  ///< the one of `automatic`; without others its own, `automatic` where it has none
  const char* missing;    ///< why this build has none of it; else null
};

/// Of the solver that `solver` resolves to.
const SolverTraits& traits_of(SolverKind solver);

/// "cg or gauss_seidel": the solvers with a trait, for messages and tables.
std::string solvers_with(bool SolverTraits::*trait);

/// What `automatic` stands for where the places of the unknowns are given.
SolverKind resolved(SolverKind solver);
OrderingKind resolved(SolverKind solver, OrderingKind ordering);

bool is_iterative(SolverKind solver);

/// Throws InputError for a solver that this build lacks and for an ordering that the solver does not take.
void check(SolverKind solver, OrderingKind ordering);

}  // namespace pfv
