// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"

#include <cstdint>

namespace pfv {

/// `Coupling::automatic`: the cheapest coupling that is stable, chosen for each network and for the first two
/// steps of a run. What an earlier run saw is forgotten, as it would be in one that starts from a restart file.
class CouplingChoice {
 public:
  Coupling chosen() const { return chosen_; }
  void begin_run() { strain_of_a_step_ = 0.0; }

  /// `limit`: of explicit steps, s; `network`: which one it is chosen for. Throws InputError where dt is beyond
  /// the limit and something stands against longer steps.
  void choose(double limit, double dt, const Step& step, const Options& options,
              Eigen::Index grains, std::int64_t network);

  /// Takes in the strain of a step on the network that is now in use; whether it is time to choose anew.
  bool is_due_after(double strain_of_the_step, std::int64_t network);

 private:
  Coupling chosen_ = Coupling::explicit_step;
  double strain_of_a_step_ = 0.0;  ///< of the last one, 0 before the first of a run
  std::int64_t network_ = 0;       ///< that it was chosen for
};

}  // namespace pfv
