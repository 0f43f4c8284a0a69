// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace pfv {

/// A block of R, where velocities are resisted by the forces -R v: on one sphere by the velocity of one, kg/s.
struct ResistanceBlock {
  int of, by;  ///< columns of the spheres
  Eigen::Matrix3d value;
};

}  // namespace pfv
