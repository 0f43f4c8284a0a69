// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/automatic_solver.hpp"

#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace pfv {

namespace {

/// In later solves of a step. Those for a limit or a query set out from nothing: some four times as many iterations.
double solves_of(const Counts& counts) {
  constexpr double from_nothing = 4.0;
  return static_cast<double>(counts.solve + counts.correction_solve) +
         from_nothing * static_cast<double>(counts.limit_solve + counts.query_solve);
}

// From doc/solvers.md, sizes: 52 and 238 solves, 178 and 1468 MB at 20 000 and 100 000 spheres.

double break_even(Eigen::Index spheres) { return 52.0 * std::pow(static_cast<double>(spheres) / 20000.0, 0.945); }

double factor_bytes(Eigen::Index spheres) { return 178e6 * std::pow(static_cast<double>(spheres) / 20000.0, 1.31); }

}  // namespace

AutomaticSolver::AutomaticSolver(const Options& options, bool shared)
    : is_open_(options.solver == SolverKind::automatic && options.ordering == OrderingKind::automatic &&
               options.precision == Precision::full && options.threads == 1 && options.rebuild_lag == 0 && !shared),
      from_(options.amg_from) {}

double AutomaticSolver::served(const Counts& counts) const { return solves_of(counts) - before_; }

void AutomaticSolver::begin(Eigen::Index spheres, const Counts& counts) {
  last_served_ = had_network_ ? served(counts) : 0.0;
  had_network_ = true;
  before_ = solves_of(counts);
  spheres_ = spheres;
  amg_failed_ = false;
}

bool AutomaticSolver::takes_factor_after_failure() {
  amg_failed_ = factor_fits();
  return amg_failed_;
}

/// Beside as much again while it is made.
bool AutomaticSolver::factor_fits() const {
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return 2.0 * factor_bytes(spheres_) < memory;
}

SolverKind AutomaticSolver::now(const Counts& counts) const {
  if (spheres_ < from_ || amg_failed_) return SolverKind::supernodal;
  if (!factor_fits()) return SolverKind::amg;
  const double enough = break_even(spheres_);
  return last_served_ > enough || served(counts) > enough ? SolverKind::supernodal : SolverKind::amg;
}

std::string AutomaticSolver::reason(SolverKind solver) const {
  if (!is_open_ || solver != SolverKind::amg) return {};
  char text[200];
  if (!factor_fits())
    std::snprintf(text, sizeof text, "auto: the factor of %ld spheres, some %.2g GB, does not fit in memory",
                  static_cast<long>(spheres_), 1e-9 * factor_bytes(spheres_));
  else
    std::snprintf(text, sizeof text, "auto: a factor of %ld spheres pays from %.0f solves a network on",
                  static_cast<long>(spheres_), break_even(spheres_));
  return text;
}

}  // namespace pfv
