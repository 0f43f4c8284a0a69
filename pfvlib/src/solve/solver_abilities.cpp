// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/solver_abilities.hpp"

#include "pfv/error.hpp"

#include <string>
#include <vector>

namespace pfv {
namespace {

#ifdef PFV_WITH_MUMPS
constexpr bool has_mumps = true;
#else
constexpr bool has_mumps = false;
#endif

using Solver = SolverKind;
using Ordering = OrderingKind;

// Not in the background: what calls the BLAS, which two threads at once may not (Debian's
// openblas-serial returns wrong factors), and what stays inside Trilinos, which is one thread's at a time.
constexpr SolverAbilities table[] = {
    // solver, built, analysed, factored, solved by; own ordering; takes orderings, shares work,
    // factors beside steps, mixed precision, iterative
    {Solver::supernodal, true, "CHOLMOD", "pfv", "pfv", Ordering::geometric, true, true, true, true, false},
    {Solver::cholmod, true, "CHOLMOD", "CHOLMOD", "CHOLMOD", Ordering::geometric, true, false, false, false, false},
    {Solver::tacho, true, "Tacho", "Tacho", "Tacho", Ordering::metis, true, false, false, false, false},
    {Solver::klu2, true, "KLU2", "KLU2", "KLU2", Ordering::amd, false, false, false, false, false},
    {Solver::mumps, has_mumps, "MUMPS", "MUMPS", "MUMPS", Ordering::automatic, false, false, false, false, false},
    {Solver::cg, true, nullptr, "pfv", "pfv", Ordering::automatic, false, false, true, false, true},
    {Solver::gauss_seidel, true, nullptr, nullptr, "pfv", Ordering::automatic, false, false, true, false, true},
};

/// "the solver a, b or c".
template <class Ability>
std::string solvers_with(const Ability& ability) {
  std::vector<std::string> names;
  for (const SolverAbilities& solver : table)
    if (solver.is_built && ability(solver)) names.push_back(name_of(solver.solver));
  std::string text = "the solver ";
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
  return text;
}

[[noreturn]] void refuse(const SolverAbilities& solver, const std::string& why) {
  throw InputError(std::string("the solver ") + name_of(solver.solver) + " " + why);
}

void check_ordering(const SolverAbilities& solver, OrderingKind ordering) {
  if (solver.takes_orderings || ordering == Ordering::automatic || ordering == solver.own_ordering)
    return;
  const std::string own = solver.own_ordering == Ordering::automatic
                              ? "auto"
                              : name_of(solver.own_ordering) + std::string(" (its own) or auto");
  refuse(solver, std::string("takes no ordering ") + name_of(ordering) + "; use the ordering " + own +
                     ", or " + solvers_with([](const auto& s) { return s.takes_orderings; }));
}

/// Who makes an ordering for a solver.
std::string orderer(const SolverAbilities& solver, OrderingKind ordering) {
  if (!solver.takes_orderings) return solver.analysed;
  if (ordering == Ordering::geometric) return "pfv";
  return ordering == Ordering::metis ? "METIS" : "CHOLMOD";
}

}  // namespace

const SolverAbilities& abilities_of(SolverKind solver) {
  for (const SolverAbilities& candidate : table)
    if (candidate.solver == resolved(solver)) return candidate;
  throw InputError("unknown solver number " + std::to_string(static_cast<int>(solver)) +
                   ": use one that options.hpp names");
}

SolverKind resolved(SolverKind solver) {
  return solver == Solver::automatic ? Solver::supernodal : solver;
}

OrderingKind resolved(SolverKind solver, OrderingKind ordering) {
  return ordering == Ordering::automatic ? abilities_of(solver).own_ordering : ordering;
}

bool is_iterative(SolverKind solver) { return abilities_of(solver).is_iterative; }

void check_solver(const Options& options) {
  const SolverAbilities& solver = abilities_of(options.solver);
  if (!solver.is_built)
    throw InputError(std::string("this build has no solver ") + name_of(solver.solver) +
                     "; configure it with -DPFV_WITH_MUMPS=ON, or use another solver");
  check_ordering(solver, options.ordering);
  if (options.rebuild_lag > 0 && !solver.factors_beside_steps)
    refuse(solver, "does not factor in the background: use " +
                       solvers_with([](const auto& s) { return s.factors_beside_steps; }) +
                       ", or set rebuild_lag to 0");
  if (options.tolerance != default_tolerance && !solver.is_iterative)
    refuse(solver, "is direct and takes no tolerance; use " +
                       solvers_with([](const auto& s) { return s.is_iterative; }));
  if (options.precision == Precision::mixed && !solver.mixed_precision)
    refuse(solver, "takes no mixed precision; use " +
                       solvers_with([](const auto& s) { return s.mixed_precision; }) +
                       ", or the precision double");
}

std::string made_of(SolverKind solver, OrderingKind ordering) {
  const SolverAbilities& s = abilities_of(solver);
  if (s.is_iterative)
    return (s.factored ? "preconditioned by " + std::string(s.factored) + ", " : std::string()) +
           "solved by " + s.solved;
  const OrderingKind kind = resolved(solver, ordering);
  const std::string name = kind == Ordering::automatic ? "" : " (" + std::string(name_of(kind)) + ")";
  return "ordered by " + orderer(s, kind) + name + ", analysed by " + s.analysed + ", factored by " +
         s.factored + ", solved by " + s.solved + "; called through Amesos2";
}

}  // namespace pfv
