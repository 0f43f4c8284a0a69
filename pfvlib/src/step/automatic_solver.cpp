// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/automatic_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace pfv {

namespace {

constexpr Eigen::Index least = 2000;   ///< spheres; below, a factor costs less than twice amg for one solve
constexpr double from_nothing = 4.0;    ///< a solve for a limit or a query, in later solves of a step: so many more iterations
constexpr double solves_of_a_limit = 25.0;

double solves_in_steps(const Counts& counts) { return static_cast<double>(counts.solve + counts.correction_solve); }

double solves_of(const Counts& counts) {
  return solves_in_steps(counts) + from_nothing * static_cast<double>(counts.limit_solve + counts.query_solve);
}

// From doc/solvers.md, sizes: 52 and 238 solves, 178 and 1468 MB at 20 000 and 100 000 spheres.

double break_even(Eigen::Index spheres) { return 52.0 * std::pow(static_cast<double>(spheres) / 20000.0, 0.945); }

double factor_bytes(Eigen::Index spheres) { return 178e6 * std::pow(static_cast<double>(spheres) / 20000.0, 1.31); }

}  // namespace

AutomaticSolver::AutomaticSolver(const Options& options, bool shared)
    : is_open_(options.solver == SolverKind::automatic && options.ordering == OrderingKind::automatic &&
               options.precision == Precision::full && options.threads == 1 && options.rebuild_lag == 0 && !shared),
      from_(options.amg_from) {}

double AutomaticSolver::served(const Counts& counts) const {
  if (!has_stepped_) return solves_of(counts) - before_;
  return in_steps_ + (has_limit_ ? from_nothing * solves_of_a_limit : 0.0);
}

void AutomaticSolver::begin(Eigen::Index spheres, const Counts& counts) {
  if (has_network_ && !is_restored_) last_served_ = served(counts);
  has_network_ = true;
  is_restored_ = has_limit_ = amg_failed_ = false;
  before_ = solves_of(counts);
  in_steps_ = 0.0;
  spheres_ = spheres;
}

void AutomaticSolver::count_step(const Counts& before, const Counts& now, bool is_long) {
  has_stepped_ = true;
  has_limit_ = has_limit_ || is_long;
  in_steps_ += solves_in_steps(now) - solves_in_steps(before);
}

void AutomaticSolver::restore(double last_served) {
  last_served_ = last_served;
  is_restored_ = has_stepped_ = true;
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
  if (amg_failed_ || spheres_ < std::min(least, from_)) return SolverKind::supernodal;
  if (last_served_ == unknown && spheres_ < from_) return SolverKind::supernodal;
  if (!factor_fits()) return SolverKind::amg;
  return std::max(last_served_, served(counts)) > break_even(spheres_) ? SolverKind::supernodal : SolverKind::amg;
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
