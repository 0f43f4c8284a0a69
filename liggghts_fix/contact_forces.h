// SPDX-License-Identifier: GPL-3.0-or-later
// The forces at the contacts of a rank's atoms, as LIGGGHTS keeps them for its `fix continuum/weighted`.
#ifndef LMP_PFV_CONTACT_FORCES_H
#define LMP_PFV_CONTACT_FORCES_H

#include "pfv/grain_stresses.hpp"

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

class PfvContactForces : protected Pointers {
 public:
  explicit PfvContactForces(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Has the pair style keep the forces of its contacts from the next run on. Throws pfv::InputError without one.
  void ask() const;
  /// Why they cannot be told, with what to do about it; empty where they can. `flow`: the fix that asks.
  std::string obstacle(const class Fix& flow) const;

  /// A row for each atom of the group on this rank: the stress that its contacts cause (xx, yy, zz, xy, xz, yz) and
  /// what its motion adds, relative to the group's centre of mass. For post_force, behind all walls. Collective.
  static constexpr int width = 12;
  std::vector<double> rows(int groupbit) const;

 private:
  pfv::ContactForces contacts() const;
};

}  // namespace LAMMPS_NS

#endif
