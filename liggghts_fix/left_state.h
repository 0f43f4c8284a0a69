// SPDX-License-Identifier: GPL-3.0-or-later
// Where grains and faces were when a run ended: what the next run finds moved since then.
#ifndef LMP_PFV_LEFT_STATE_H
#define LMP_PFV_LEFT_STATE_H

#include "pfv/packing.hpp"

#include <cstddef>
#include <cstdint>
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

/// Of what a restart file keeps this in place of the state: two that differ have different numbers, but for one
/// pair in 2^64 (FNV-1a, 64 bits).
inline std::uint64_t fingerprint(const PfvLeftState& state) {
  std::uint64_t hash = 14695981039346656037u;
  const auto take = [&hash](const auto& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    const std::size_t size = static_cast<std::size_t>(values.size()) * sizeof *values.data();
    for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 1099511628211u;
  };
  take(state.grains.ids);
  take(state.grains.positions);
  take(state.grains.radii);
  take(state.faces);
  return hash;
}

}  // namespace LAMMPS_NS

#endif
