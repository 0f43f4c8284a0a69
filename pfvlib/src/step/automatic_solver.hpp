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
/// not known before. Large networks begin with amg, unless the one before has served more than that, and change over to
/// a factor once they have: at worst twice what the better choice would have cost, and about as much where networks
/// are alike. A pure function of what it is told.
class AutomaticSolver {
 public:
  /// Open unless the options ask for what belongs to a factor, or several ranks share the packing.
  AutomaticSolver(const Options& options, bool shared);
  bool is_open() const { return is_open_; }

  /// A new network of so many spheres; `counts`: of the work so far.
  void begin(Eigen::Index spheres, const Counts& counts);
  SolverKind now(const Counts& counts) const;
  /// amg came to no solution on this network. Whether a factor is to be tried in its place.
  bool takes_factor_after_failure();
  /// Why amg serves, where `solver`, that of the present network, is amg: a clause for the report; else empty.
  std::string reason(SolverKind solver) const;

 private:
  bool factor_fits() const;
  double served(const Counts& counts) const;

  bool is_open_;
  Eigen::Index from_;            ///< spheres
  Eigen::Index spheres_ = 0;     ///< of the present network
  double before_ = 0.0;          ///< solves of all networks when it began
  double last_served_ = 0.0;     ///< by the network before
  bool had_network_ = false;
  bool amg_failed_ = false;      ///< on the present network
};

}  // namespace pfv
