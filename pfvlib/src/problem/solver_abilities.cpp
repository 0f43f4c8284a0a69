// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/solver_abilities.hpp"

#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace pfv {
namespace {

#ifdef PFV_WITH_MUMPS
constexpr bool has_mumps = true;
#else
constexpr bool has_mumps = false;
#endif

using Ordering = OrderingKind;

/// Who makes an ordering for a solver.
std::string orderer(const SolverAbilities& solver, OrderingKind ordering) {
  if (!solver.takes_orderings) return solver.analysed;
  if (ordering == Ordering::geometric) return "pfv";
  return ordering == Ordering::metis ? "METIS" : "CHOLMOD";
}

}  // namespace

const SolverAbilities& abilities_of(SolverKind solver) {
  for (const SolverAbilities& candidate : Names<SolverKind>::all)
    if (candidate.value == resolved(solver)) return candidate;
  throw InputError("unknown solver number " + std::to_string(static_cast<int>(solver)) +
                   ": use one that options.hpp names");
}

bool is_built(SolverKind solver) { return solver != SolverKind::mumps || has_mumps; }

SolverKind resolved(SolverKind solver) {
  return solver == SolverKind::automatic ? SolverKind::supernodal : solver;
}

OrderingKind resolved(SolverKind solver, OrderingKind ordering) {
  return ordering == Ordering::automatic ? abilities_of(solver).own_ordering : ordering;
}

bool is_iterative(SolverKind solver) { return abilities_of(solver).is_iterative; }

std::string solvers_with(bool SolverAbilities::*ability) {
  std::vector<std::string> names;
  for (const SolverAbilities& solver : Names<SolverKind>::all)
    if (is_built(solver.value) && solver.*ability) names.push_back(solver.name);
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
  return text;
}

std::string own_tolerances() {
  std::map<double, std::string, std::greater<>> solvers;
  for (const SolverAbilities& solver : Names<SolverKind>::all) {
    if (!solver.is_iterative) continue;
    std::string& names = solvers[solver.tolerance];
    names += (names.empty() ? "" : ", ") + std::string(solver.name);
  }
  std::string text;
  for (const auto& [tolerance, names] : solvers)
    text += (text.empty() ? "" : ", ") + detail::number_text(tolerance) + " (" + names + ")";
  return text;
}

void check(SolverKind kind, OrderingKind ordering) {
  const SolverAbilities& solver = abilities_of(kind);
  const std::string name = solver.name;
  if (!is_built(solver.value))
    throw InputError("this build has no solver " + name +
                     "; configure it with -DPFV_WITH_MUMPS=ON, or use another solver");
  if (solver.takes_orderings || ordering == Ordering::automatic || ordering == solver.own_ordering)
    return;
  const std::string own = solver.own_ordering == Ordering::automatic
                              ? "auto"
                              : name_of(solver.own_ordering) + std::string(" (its own) or auto");
  throw InputError("the solver " + name + " takes no ordering " + name_of(ordering) +
                   "; use the ordering " + own + ", or the solver " +
                   solvers_with(&SolverAbilities::takes_orderings));
}

std::string made_of(SolverKind solver, OrderingKind ordering) {
  const SolverAbilities& s = abilities_of(solver);
  if (s.is_iterative)
    return (s.factored ? "preconditioned by " + std::string(s.factored) + ", " : std::string()) +
           "solved by " + s.solved;
  const OrderingKind kind = resolved(solver, ordering);
  const std::string name = kind == Ordering::automatic ? "" : " (" + std::string(name_of(kind)) + ")";
  return "ordered by " + orderer(s, kind) + name + ", analysed by " + s.analysed + ", factored by " +
         s.factored + ", solved by " + s.solved + (s.shared_by_ranks ? "" : "; called through Amesos2");
}

}  // namespace pfv
