// SPDX-License-Identifier: GPL-3.0-or-later
// Where grains and faces were when a run ended: what the next run finds moved since then.
#ifndef LMP_PFV_LEFT_STATE_H
#define LMP_PFV_LEFT_STATE_H

#include "pfv/packing.hpp"

#include <vector>

namespace LAMMPS_NS {

struct PfvLeftState {
  pfv::PackingArrays grains;       ///< without velocities
  std::vector<double> faces;       ///< m

  /// To the last bit: a network is kept only for what it was built from or has followed itself.
  bool operator==(const PfvLeftState& other) const {
    const pfv::PackingArrays& others = other.grains;
    return others.ids.size() == grains.ids.size() && others.ids == grains.ids &&
           others.positions == grains.positions && others.radii == grains.radii && other.faces == faces;
  }
};

/// `positions`: the packing's, wrapped as LIGGGHTS wraps them when a run begins.
inline PfvLeftState left_state(const pfv::Packing& packing, const Eigen::Matrix3Xd& positions,
                               const std::vector<double>& faces) {
  PfvLeftState state;
  state.grains.ids = packing.ids;
  state.grains.positions = positions;
  state.grains.radii = packing.radii;
  state.faces = faces;
  return state;
}

}  // namespace LAMMPS_NS

#endif
