// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/grain_jumps.hpp"

namespace pfv {

void GrainJumps::pass(const Packing& packing, double step) {
  places_ = packing.positions;
  ways_.setZero(packing.size());
  if (packing.velocities.cols() == packing.size()) ways_ = step * packing.velocities.colwise().norm().transpose();
}

bool GrainJumps::any(const Packing& packing, const std::vector<int>& columns, const Lattice& lattice, double step,
                     double part) const {
  if (places_.cols() != packing.size()) return false;  // other grains: that is seen elsewhere
  const bool moves = step > 0.0 && packing.velocities.cols() == packing.size();
  for (const int k : columns) {
    if (k >= packing.size()) continue;  // seen of another rank, which looks at its own
    const double allowed = part * packing.radii[k];
    Eigen::Vector3d moved = packing.positions.col(k) - places_.col(k);
    if (moved.squaredNorm() <= allowed * allowed) continue;  // nearly all, at each step
    moved -= lattice.displacement(lattice.nearest(moved));  // the host may have wrapped it
    const double explained = ways_[k] + (moves ? step * packing.velocities.col(k).norm() : 0.0);
    if (moved.norm() > explained + allowed) return true;
  }
  return false;
}

}  // namespace pfv
