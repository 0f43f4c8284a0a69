// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "step/problem.hpp"
#include "step/built_network.hpp"
#include "work/work_record.hpp"

#include <array>
#include <optional>

namespace pfv {

/// The limit of the explicit step, dt < 2 / lambda_max(M^-1 S G^-1 S^T), kept while factor, masses and R stay.
class TimeStepLimit {
 public:
  /// s; infinite where nothing resists. `masses` of the packing's spheres, kg. Cost: some 15 to 35 solves,
  /// none when it is kept. Throws InputError.
  double of(BuiltNetwork& built, const Problem& problem, Eigen::Index spheres,
            const Eigen::VectorXd& masses, const std::vector<Piston>& pistons,
            const std::vector<RigidBody>& bodies, WorkRecord& work);
  void forget() { limit_.reset(); }

 private:
  std::optional<double> limit_;
  bool still_water_ = true;  ///< whose R is in it (KeptOperators)
  Eigen::VectorXd masses_;  ///< that it belongs to: of the spheres and the faces, then those and the inertias of bodies
};

}  // namespace pfv
