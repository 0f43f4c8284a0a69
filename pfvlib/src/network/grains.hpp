// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/container.hpp"
#include "pfv/options.hpp"
#include "pfv/packing.hpp"

#include <cstdint>
#include <vector>

namespace pfv {

/// The grains that take part in the flow: those with their centre inside the container.
struct ActiveGrains {
  std::vector<int> columns;  ///< of the packing, ascending
  Spheres spheres;           ///< the same grains, in coordinates from the lower corner of the box around it
  bool any_bodies = false;  ///< rigid ones, on any rank; without them what follows is empty
  Eigen::VectorXi held;     ///< the packing's bodies, one entry for each of its spheres
  std::vector<int> body;    ///< of each grain, -1 for none
};

/// Throws InputError for arrays of different lengths, numbers that are not finite, radii <= 0, repeated ids.
void check_spheres(const Packing& packing);

/// What a step reads of the spheres whatever network they have: InputError where it is not finite.
void check_motion(const Packing& packing);
/// Throws InputError for arrays of different lengths, numbers that are not finite, radii <= 0 or a
/// thousand times the box, repeated ids, and (OutsideGrains::refuse) a centre that is not inside the
/// container or no grain at all.
ActiveGrains select_grains(const Packing& packing, const Container& container, OutsideGrains outside);

/// The rigid body that holds a sphere, or -1.
inline int body_of(const Packing& packing, Eigen::Index column) {
  return packing.bodies.size() > 0 ? packing.bodies[column] : -1;
}
bool has_bodies(const Packing& packing);
/// Takes up which grains rigid bodies hold, there being some.
void note_bodies(ActiveGrains& grains, const Packing& packing);
/// Whether rigid bodies hold the same spheres as when the grains were selected, which came first among theirs.
bool holds_the_same(const ActiveGrains& grains, const Packing& packing);
/// Cheap tests of each step.
bool is_inside(const Packing& packing, Eigen::Index column, const Container& container);
/// Whether the packing still has the spheres of these ids, in their order, and those in these columns alone
/// are inside the container.
bool same_grains(const Packing& packing, const Container& container, const std::vector<std::int64_t>& ids,
                 const std::vector<int>& columns);
/// Moment of inertia of a solid sphere, kg m².
inline double inertia_of(double mass, double radius) { return 0.4 * mass * radius * radius; }
/// 3 x active spheres; zeros where the packing has none.
void gather_velocities(const Packing& packing, const std::vector<int>& columns,
                       Eigen::Matrix3Xd& velocities);
/// m³: what the lift of a sphere counts.
double displaced_volume(const Packing& packing, Eigen::Index column);
bool at_rest(const Packing& packing, const Container& container, bool spins = false);

}  // namespace pfv
