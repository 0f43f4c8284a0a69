// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/solver_traits.hpp"

#include "pfv/error.hpp"

#include <array>

namespace pfv {
namespace {

#ifdef PFV_WITH_MUMPS
constexpr const char* without_mumps = nullptr;
#else
constexpr const char* without_mumps = "configure it with -DPFV_WITH_MUMPS=ON";
#endif

//                       iterative mixed background orderings, the one of `automatic`
constexpr std::array<SolverTraits, 5> all_traits{
    {{SolverKind::cholmod, false, true, true, true, OrderingKind::geometric, nullptr},
     {SolverKind::klu2, false, false, false, false, OrderingKind::amd, nullptr},
     {SolverKind::mumps, false, false, false, false, OrderingKind::automatic, without_mumps},
     {SolverKind::cg, true, false, true, false, OrderingKind::automatic, nullptr},
     {SolverKind::gauss_seidel, true, false, true, false, OrderingKind::automatic, nullptr}}};

}  // namespace

SolverKind resolved(SolverKind solver) {
  return solver == SolverKind::automatic ? SolverKind::cholmod : solver;
}

const SolverTraits& traits_of(SolverKind solver) {
  for (const SolverTraits& traits : all_traits)
    if (traits.kind == resolved(solver)) return traits;
  throw InputError(std::string("the solver ") + name_of(solver) + " has no traits");
}

std::string solvers_with(bool SolverTraits::*trait) {
  std::string names;
  for (const SolverTraits& traits : all_traits)
    if (traits.*trait) names += (names.empty() ? "" : " or ") + std::string(name_of(traits.kind));
  return names;
}

OrderingKind resolved(SolverKind solver, OrderingKind ordering) {
  return ordering == OrderingKind::automatic ? traits_of(solver).ordering : ordering;
}

bool is_iterative(SolverKind solver) { return traits_of(solver).iterative; }

void check(SolverKind solver, OrderingKind ordering) {
  const SolverTraits& traits = traits_of(solver);
  const std::string name = name_of(traits.kind);
  if (traits.missing)
    throw InputError("this build has no solver " + name + "; " + traits.missing + ", or use the solver " +
                     name_of(resolved(SolverKind::automatic)));
  if (traits.takes_orderings || ordering == OrderingKind::automatic || ordering == traits.ordering) return;
  const bool has_own = traits.ordering != OrderingKind::automatic;
  const std::string own =
      has_own ? std::string("the ordering ") + name_of(traits.ordering) + " (its own) or auto" : "the ordering auto";
  throw InputError("the solver " + name + " takes no ordering " + name_of(ordering) + "; use " + own +
                   ", or the solver " + solvers_with(&SolverTraits::takes_orderings));
}

}  // namespace pfv
