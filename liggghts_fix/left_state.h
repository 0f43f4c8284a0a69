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

/// A number of these bytes (FNV-1a, 64 bits, mixed once more so that sums of such numbers tell, too).
inline std::uint64_t hash_of(const double* values, std::size_t count) {
  std::uint64_t hash = 14695981039346656037u;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values);
  for (std::size_t k = 0; k < count * sizeof *values; ++k) hash = (hash ^ bytes[k]) * 1099511628211u;
  hash = (hash ^ (hash >> 31)) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

/// Of what a restart file keeps this in place of the state: a sum (modulo 2^64) over its grains, so that their order and
/// the ranks that have them do not count, and of its faces. Two that differ have different numbers, but for one pair in
/// 2^64.
inline std::uint64_t fingerprint_of_grains(const PfvLeftState& state) {
  std::uint64_t sum = 0;
  for (Eigen::Index k = 0; k < state.grains.ids.size(); ++k) {
    const auto place = state.grains.positions.col(k);
    const double grain[]{static_cast<double>(state.grains.ids[k]), place[0], place[1], place[2], state.grains.radii[k]};
    sum += hash_of(grain, 5);
  }
  return sum;
}

}  // namespace LAMMPS_NS

#endif
