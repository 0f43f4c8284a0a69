// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/options.hpp"
#include "pfv/report.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace pfv {

/// Which solver serves a network where `solver auto` leaves it open. A factor costs more than amg's hierarchy and each
/// of its solves less, so that it pays from some number of solves on (doc/solvers.md, sizes); how many there will be is
/// not known before: as many as the network before has served, where there was one. The first network of a run begins with
/// a factor, of `Options::amg_from` spheres and more with amg. One that began with amg changes over to a factor once it has
/// served as many solves as a factor takes to pay: at worst twice what the better choice would have cost, and about as much
/// where networks are alike. A pure function of what it is told. Once a step has been committed steps alone count, not what
/// the setup of a run solves beside: one that goes on from a restart file chooses as the one that wrote it.
class AutomaticSolver {
 public:
  static constexpr double unknown = -1.0;

  /// Open unless the options ask for what belongs to a factor, or several ranks share the packing.
  AutomaticSolver(const Options& options, bool shared);
  bool is_open() const { return is_open_; }

  /// A new network of so many spheres; `counts`: of the work so far.
  void begin(Eigen::Index spheres, const Counts& counts);
  /// A committed step, by the counts before it and now; `is_long`: it needs the limit of explicit steps.
  void count_step(const Counts& before, const Counts& now, bool is_long);
  SolverKind now(const Counts& counts) const;
  /// amg came to no solution on this network. Whether a factor is to be tried in its place.
  bool takes_factor_after_failure();
  /// Why amg serves, where `solver`, that of the present network, is amg: a clause for the report; else empty.
  std::string reason(SolverKind solver) const;

  /// Solves that the network before has served, or `unknown`, for one that goes on from here.
  double last_served() const { return last_served_; }
  void restore(double last_served);

 private:
  bool factor_fits() const;
  double served(const Counts& counts) const;

  bool is_open_;
  Eigen::Index from_;            ///< spheres
  Eigen::Index spheres_ = 0;     ///< of the present network
  double before_ = 0.0;          ///< solves of all networks when it began
  double in_steps_ = 0.0;        ///< that it has served in committed steps
  bool has_stepped_ = false;     ///< whether there were any, on any network
  bool has_limit_ = false;       ///< of this network
  bool has_network_ = false;
  bool is_restored_ = false;     ///< last_served_ is that of the next network
  double last_served_ = unknown; ///< by the network before
  bool amg_failed_ = false;      ///< on the present network
};

}  // namespace pfv
