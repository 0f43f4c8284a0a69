// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/packing.hpp"
#include "problem/lattice.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Watches the grains between networks, as FaceJumps the faces: pores follow a grain that moves with its velocity, and the
/// strain tells how far; of one that is put elsewhere, as by a host that shows one packing after the other, it tells
/// nothing.
class GrainJumps {
 public:
  /// A network has been built for the packing, or a step (s) has been taken in it.
  void pass(const Packing& packing, double step);
  /// Whether one of the grains in `columns` lies further from where it was then than the velocities of that step and of this
  /// one (s; 0: a look at the grains, which takes none) bring it, by more than this part of its radius.
  bool any(const Packing& packing, const std::vector<int>& columns, const Lattice& lattice, double step, double part) const;

 private:
  Eigen::Matrix3Xd places_;  // m
  Eigen::VectorXd ways_;     // in the step, m
};

}  // namespace pfv
