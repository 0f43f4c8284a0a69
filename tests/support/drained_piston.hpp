// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "support/packings.hpp"

namespace support {

/// 60 grains below a drained piston in the unit cube.
struct DrainedPiston {
  pfv::PackingArrays packing = random_packing(60, 0.05, 0.1, 3);
  pfv::Box box;

  DrainedPiston() {
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
    packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.positions.cols());
  }
  /// Piston and grains: v = (0, 0, -rate z), 1/s.
  void sink(double rate) {
    box[pfv::Face::zhi].velocity = -rate;
    packing.velocities.row(2) = -rate * packing.positions.row(2);
  }
};

}  // namespace support
