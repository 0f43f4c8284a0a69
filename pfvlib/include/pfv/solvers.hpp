// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/names.hpp"

namespace pfv {

/// Fill-reducing ordering: nested dissection of the pore centres in space (`automatic`) or of the
/// graph by METIS (tacho's `automatic`), or minimum degree: of supernodal, cholmod and tacho. The other
/// solvers order themselves or not at all and refuse a choice (klu2 takes amd, its own).
enum class OrderingKind { automatic, geometric, metis, amd };
template <>
struct Names<OrderingKind> {
  static constexpr const char* what = "ordering";
  static constexpr std::array<Named<OrderingKind>, 4> all{
      {{OrderingKind::automatic, "auto"},
       {OrderingKind::geometric, "geometric"},
       {OrderingKind::metis, "metis"},
       {OrderingKind::amd, "amd"}}};
};

/// Direct solvers, behind Amesos2 but for mumps: supernodal (`automatic`), CHOLMOD's symbolic factorisation with numeric
/// one and solves of this library; cholmod, CHOLMOD's own; tacho, Trilinos' sparse Cholesky; klu2, its plain
/// sparse LU; mumps (unless CMake's PFV_WITH_MUMPS is off). Iterative ones: amg, conjugate gradients with
/// hypre's algebraic multigrid; cg, with incomplete Cholesky; gauss_seidel with over-relaxation.
enum class SolverKind { automatic, supernodal, cholmod, tacho, klu2, mumps, amg, cg, gauss_seidel };

/// What a solver is called, what it is made of and what it can do: the one place that says so. Every check of the
/// options and every error about them reads it; how solvers work is the business of solve/.
struct SolverAbilities {
  SolverKind value;
  const char* name;
  const char* analysed;       ///< the code that makes the symbolic factorisation; null: there is none
  const char* factored;       ///< the code of the numeric factorisation, or of the preconditioner
  const char* solved;         ///< the code of the triangular solves, or of the iterations
  OrderingKind own_ordering;  ///< what `automatic` stands for; `automatic`: it tells nobody
  bool takes_orderings;       ///< geometric, metis and amd; if not, its own at most
  bool shares_work;           ///< threads share factorisation and solves
  bool factors_beside_steps;  ///< networks may be rebuilt in the background
  bool shared_by_ranks;       ///< several ranks may solve together
  bool mixed_precision;
  bool implicit_steps;  ///< solves the matrix of implicit steps, which is quasi-definite
  bool is_iterative;    ///< ends at a tolerance
  double tolerance;     ///< where an iterative solver ends where none is said; 0 for the others
};

// Not in the background: what calls the BLAS, which two threads at once may not (Debian's
// openblas-serial returns wrong factors), and what stays inside Trilinos, which is one thread's at a time.
template <>
struct Names<SolverKind> {
  static constexpr const char* what = "solver";
  // solver, name, analysed, factored, solved by; own ordering; takes orderings, shares work, factors beside steps,
  // shared by ranks, mixed precision, implicit steps, iterative, tolerance
  static constexpr std::array<SolverAbilities, 9> all{
      {{SolverKind::automatic, "auto", nullptr, nullptr, nullptr, OrderingKind::automatic,
        false, false, false, false, false, false, false, 0.0},  // stands for another: abilities_of
       {SolverKind::supernodal, "supernodal", "CHOLMOD", "pfv", "pfv", OrderingKind::geometric,
        true, true, true, false, true, true, false, 0.0},
       {SolverKind::cholmod, "cholmod", "CHOLMOD", "CHOLMOD", "CHOLMOD", OrderingKind::geometric,
        true, false, false, false, false, false, false, 0.0},
       {SolverKind::tacho, "tacho", "Tacho", "Tacho", "Tacho", OrderingKind::metis,
        true, false, false, false, false, false, false, 0.0},
       {SolverKind::klu2, "klu2", "KLU2", "KLU2", "KLU2", OrderingKind::amd,
        false, false, false, false, false, false, false, 0.0},
       {SolverKind::mumps, "mumps", "MUMPS", "MUMPS", "MUMPS", OrderingKind::automatic,
        false, false, false, true, false, false, false, 0.0},
       {SolverKind::amg, "amg", nullptr, "hypre's BoomerAMG", "pfv", OrderingKind::automatic,
        false, false, true, true, false, false, true, 1e-7},
       {SolverKind::cg, "cg", nullptr, "pfv", "pfv", OrderingKind::automatic,
        false, false, true, false, false, false, true, 1e-10},
       {SolverKind::gauss_seidel, "gauss_seidel", nullptr, nullptr, "pfv", OrderingKind::automatic,
        false, false, true, false, false, false, true, 1e-10}}};
};

}  // namespace pfv
