// SPDX-License-Identifier: GPL-3.0-or-later
// What other fixes do to the grains of a flow: who moves them, who holds them, who adds forces.
#ifndef LMP_PFV_OTHER_FIXES_H
#define LMP_PFV_OTHER_FIXES_H

#include "pointers.h"

#include <Eigen/Core>
#include <string>

namespace LAMMPS_NS {

/// Grains by the bits of their groups.
struct PfvGroups {
  int flow = 0;   ///< the grains of the flow
  int moved = 0;  ///< those that a fix integrates with the forces on them
  int turned = 0;  ///< those whose spin it integrates with the torques, too
  int held = 0;   ///< those whose force is overwritten, or whose velocity is prescribed, all the same

  /// Whether a force of the fluid changes the velocity of a grain with this mask.
  bool free(int mask) const { return (mask & moved) && !(mask & held); }
  bool free_to_turn(int mask) const { return (mask & turned) && !(mask & held); }
};

/// What the other fixes mean for the flow.
struct PfvOfOthers {
  PfvGroups groups;
  bool rigid_bodies = false;  ///< grains of the flow are parts of some
  std::string obstacle;       ///< why it cannot be staged or implicit, with what to do about it; or empty
};

/// "fix STYLE 'ID'", for messages.
std::string name_of(const class Fix& fix);

class PfvOtherFixes : protected Pointers {
 public:
  PfvOtherFixes(class LAMMPS* lmp, const class Fix& flow) : Pointers(lmp), flow_(flow) {}

  /// `long_steps`: whether obstacles to staged and implicit steps are asked for. Collective.
  PfvOfOthers seen(bool long_steps) const;

  bool share_grains_with(const class Fix& other) const;  ///< collective

  /// m/s2, that of the fluid: what the fixes gravity of a grain add up to, which is the same for all grains that have
  /// any. Throws InputError with two of them where it is not. Collective where there are several such fixes.
  Eigen::Vector3d gravity() const;

 private:
  PfvGroups groups() const;
  /// Why the flow cannot be staged or implicit among these fixes, with what to do about it; empty where
  /// it can. Such a step has to know each force that acts beside the fluid's over it. Collective.
  std::string obstacle_to_long_steps() const;

  /// Whether grains of the flow are parts of rigid bodies; collective.
  bool rigid_bodies() const;
  bool moves_bodies_of_flow(const class Fix& fix) const;  ///< collective

  const class Fix& flow_;
};

}  // namespace LAMMPS_NS

#endif
