// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/linear_solver.hpp"

#include "pfv/error.hpp"
#include "solve/amg_solver.hpp"
#include "solve/cholesky_factor.hpp"
#include "solve/iterative_solvers.hpp"
#include "solve/mumps_solver.hpp"
#include "problem/solver_abilities.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace pfv {

// Each is defined in the file of its solver.
std::shared_ptr<CholeskyFactor> make_supernodal_cholesky(Precision precision);
std::shared_ptr<CholeskyFactor> make_cholmod_cholesky();
/// Kokkos must run as long as it lives.
std::shared_ptr<CholeskyFactor> make_tacho_cholesky();
/// Of this factor, or where there is none of the solver of Amesos2 itself.
std::unique_ptr<LinearSolver> make_amesos2_solver(const Options& options, std::shared_ptr<CholeskyFactor> factor,
                                                  std::shared_ptr<Team> team);

namespace {

using Made = std::unique_ptr<LinearSolver>;

/// What a solver is made with.
struct Order {
  const Options& options;
  double tolerance;
  std::shared_ptr<Team> team;
};

struct Maker {
  SolverKind solver;
  Made (*make)(const Order& order);
};

constexpr Maker makers[] = {
    {SolverKind::supernodal, [](const Order& o) -> Made {
       return make_amesos2_solver(o.options, make_supernodal_cholesky(o.options.precision), o.team);
     }},
    {SolverKind::cholmod, [](const Order& o) -> Made {
       return make_amesos2_solver(o.options, make_cholmod_cholesky(), o.team);
     }},
    {SolverKind::tacho, [](const Order& o) -> Made {
       return make_amesos2_solver(o.options, make_tacho_cholesky(), o.team);
     }},
    {SolverKind::klu2, [](const Order& o) -> Made { return make_amesos2_solver(o.options, nullptr, o.team); }},
    {SolverKind::mumps, [](const Order&) -> Made {
#ifdef PFV_WITH_MUMPS
       return std::make_unique<MumpsSolver>();
#else
       return nullptr;  // refused before
#endif
     }},
    {SolverKind::amg, [](const Order& o) -> Made { return std::make_unique<AmgSolver>(o.tolerance); }},
    {SolverKind::cg, [](const Order& o) -> Made { return std::make_unique<IncompleteCholesky>(o.tolerance); }},
    {SolverKind::gauss_seidel, [](const Order& o) -> Made { return std::make_unique<GaussSeidel>(o.tolerance); }}};
static_assert(std::size(makers) + 1 == Names<SolverKind>::all.size(), "automatic alone stands for another");

}  // namespace

void LinearSolver::share_rows(std::shared_ptr<const RowShare>) {
  throw InputError("the solver " + name() + " runs on one rank; on several give " + solvers_with(&SolverAbilities::shared_by_ranks));
}

std::unique_ptr<LinearSolver> make_solver(const Options& options, std::shared_ptr<Team> team) {
  check(options);
  const SolverAbilities& solver = abilities_of(options.solver);
  if (!team) team = std::make_shared<Team>();
  const auto* maker = std::find_if(std::begin(makers), std::end(makers), [&](const Maker& one) {
    return one.solver == solver.value;
  });
  return maker->make({options, options.tolerance.value_or(solver.tolerance), std::move(team)});
}

std::unique_ptr<LinearSolver> make_solver(SolverKind solver, OrderingKind ordering) {
  Options options;
  options.solver = solver;
  options.ordering = ordering;
  return make_solver(options);
}

double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b) {
  const double scale = b.norm();
  if (b.size() == 0 || scale == 0.0) return 0.0;
  return (b - multiply(matrix, x)).norm() / scale;
}

}  // namespace pfv
