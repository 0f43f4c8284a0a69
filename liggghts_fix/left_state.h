// SPDX-License-Identifier: GPL-3.0-or-later
// Where grains and faces were when a run ended: what the next run finds moved since then.
#ifndef LMP_PFV_LEFT_STATE_H
#define LMP_PFV_LEFT_STATE_H

#include "pfv/packing.hpp"

#include <array>

namespace LAMMPS_NS {

struct PfvLeftState {
  pfv::PackingArrays grains;       ///< without velocities
  std::array<double, 6> faces{};   ///< m

  /// To the last bit: a network is kept only for what it was built from or has followed itself.
  bool is(const pfv::Packing& packing, const std::array<double, 6>& positions) const {
    return packing.size() == grains.ids.size() && packing.ids == grains.ids &&
           packing.positions == grains.positions && packing.radii == grains.radii &&
           positions == faces;
  }
};

inline PfvLeftState left_state(const pfv::Packing& packing, const std::array<double, 6>& faces) {
  PfvLeftState state;
  state.grains.ids = packing.ids;
  state.grains.positions = packing.positions;
  state.grains.radii = packing.radii;
  state.faces = faces;
  return state;
}

}  // namespace LAMMPS_NS

#endif
