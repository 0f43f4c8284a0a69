// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/solver_abilities.hpp"

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
                     ", or the solver " + solvers_with(&SolverAbilities::takes_orderings));
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

std::string solvers_with(bool SolverAbilities::*ability) {
  std::vector<std::string> names;
  for (const SolverAbilities& solver : table)
    if (solver.is_built && solver.*ability) names.push_back(name_of(solver.solver));
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
  return text;
}

void check_solver(SolverKind kind, OrderingKind ordering) {
  const SolverAbilities& solver = abilities_of(kind);
  if (!solver.is_built)
    throw InputError(std::string("this build has no solver ") + name_of(solver.solver) +
                     "; configure it with -DPFV_WITH_MUMPS=ON, or use another solver");
  check_ordering(solver, ordering);
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
