// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <vector>

namespace pfv {

/// Watches the faces between networks: pores follow a face that moves with its velocity, not one that is put elsewhere.
class FaceJumps {
 public:
  /// A network has been built for the container.
  void begin(const Container& container, double step);
  /// A step has been taken in it.
  void pass(const Container& container, double step);
  /// Whether a face lies further from where the last step had it than the velocities of that step and of this one (s)
  /// bring it, by more than `at_once` (m), or all such ways since the network was built exceed `in_all`.
  bool any(const Container& container, double step, double at_once, double in_all) const;
  /// By how much the container has grown since the last call by faces that had no velocity all the while, m³: the host has
  /// put them elsewhere, with the fluid that is there (a free surface that follows the outermost grains).
  double volume_put(const Container& container);

 private:
  std::vector<double> unexplained_ways(const Container& container, double step) const;

  Container last_;
  std::vector<Surface> stood_;  ///< the faces at the last call of `volume_put`
  std::vector<bool> moved_;     ///< by a velocity since then
  double last_step_ = 0.0;
  std::vector<double> drifts_;  ///< of the faces since the network was built, m
};

}  // namespace pfv
