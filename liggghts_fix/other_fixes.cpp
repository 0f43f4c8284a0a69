// SPDX-License-Identifier: GPL-3.0-or-later
#include "other_fixes.h"

#include "private_member.h"

#include "pfv/error.hpp"

#include "atom.h"
#include "fix.h"
#include "fix_gravity.h"
#include "fix_multisphere.h"
#include "fix_setforce.h"
#include "modify.h"

#include <mpi.h>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

PFV_PRIVATE_MEMBER(PfvStyleX, int, FixSetForce, xstyle)
PFV_PRIVATE_MEMBER(PfvStyleY, int, FixSetForce, ystyle)
PFV_PRIVATE_MEMBER(PfvStyleZ, int, FixSetForce, zstyle)
PFV_PRIVATE_MEMBER(PfvVariableX, char*, FixSetForce, xstr)
PFV_PRIVATE_MEMBER(PfvVariableY, char*, FixSetForce, ystr)
PFV_PRIVATE_MEMBER(PfvVariableZ, char*, FixSetForce, zstr)
PFV_PRIVATE_MEMBER(PfvRegion, int, FixSetForce, iregion)

namespace {

std::string style_of(const Fix& fix) { return fix.style; }

/// Whether the fix sets all three components of the force of all its grains. The style of a variable
/// is not known before that fix's own init.
bool overwrites_forces(const Fix& fix) {
  if (style_of(fix) == "freeze") return true;
  const auto* set = dynamic_cast<const FixSetForce*>(&fix);
  if (!set || set->*member(PfvRegion()) >= 0) return false;
  return (set->*member(PfvVariableX()) || set->*member(PfvStyleX())) &&
         (set->*member(PfvVariableY()) || set->*member(PfvStyleY())) &&
         (set->*member(PfvVariableZ()) || set->*member(PfvStyleZ()));
}

bool prescribes_velocities(const Fix& fix) {
  return style_of(fix) == "move" || style_of(fix) == "nve/noforce";
}

/// Those that have a POST_FORCE but read forces only, or change something else.
bool leaves_forces_alone(const Fix& fix) {
  static const std::array<const char*, 4> styles{"pfv", "store/force", "heat/gran",
                                                 "heat/gran/conduction"};
  return std::find(styles.begin(), styles.end(), style_of(fix)) != styles.end();
}

/// What acts on some grains of the flow: which of the fixes gravity, and their sum.
struct Gravity {
  std::size_t fixes = 0;  ///< a bit for each
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
};

Gravity sum_of(const std::vector<FixGravity*>& all, std::size_t bits) {
  Gravity of{bits, Eigen::Vector3d::Zero()};
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!(bits >> k & 1)) continue;
    Eigen::Vector3d one;
    all[k]->get_gravity(one.data());
    of.sum += one;
  }
  return of;
}

std::string names_of(const std::vector<FixGravity*>& all, const Gravity& one) {
  std::string names;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (one.fixes >> k & 1) names += (names.empty() ? "" : " and ") + name_of(*all[k]);
  return names;
}

constexpr std::size_t most_fixes_gravity = 16;

}  // namespace

std::string name_of(const Fix& fix) { return "fix " + style_of(fix) + " '" + fix.id + "'"; }

PfvGroups PfvOtherFixes::groups() const {
  PfvGroups groups;
  groups.flow = flow_.groupbit;
  bool later = false;
  for (int i = 0; i < modify->nfix; ++i) {
    const Fix& other = *modify->fix[i];
    if (&other == &flow_) {
      later = true;
    } else if (prescribes_velocities(other) || (later && overwrites_forces(other))) {
      groups.held |= other.groupbit;
    } else if (other.time_integrate) {
      groups.moved |= other.groupbit;
      if (style_of(other).find("sphere") != std::string::npos) groups.turned |= other.groupbit;
    }
  }
  return groups;
}

PfvOfOthers PfvOtherFixes::seen(bool long_steps) const {
  return {groups(), rigid_bodies(), long_steps ? obstacle_to_long_steps() : std::string()};
}

std::string PfvOtherFixes::obstacle_to_long_steps() const {
  bool later = false;
  for (int i = 0; i < modify->nfix; ++i) {
    const Fix& other = *modify->fix[i];
    if (&other == &flow_) {
      later = true;
      continue;
    }
    const bool acts = modify->fmask[i] & FixConst::POST_FORCE;
    const bool frozen_before = !later && style_of(other) == "freeze";
    const bool adds_later =
        later && acts && !overwrites_forces(other) && !leaves_forces_alone(other);
    if (!frozen_before && !adds_later) continue;
    if (!share_grains_with(other)) continue;
    if (frozen_before)
      return name_of(other) + " stands before this fix, so that the fluid would move its grains; "
                              "define it after this fix";
    return name_of(other) + " adds forces after this fix, which staged and implicit "
                            "coupling would not know of; "
                            "define this fix after it, as the last one that adds forces";
  }
  return {};
}

bool PfvOtherFixes::rigid_bodies() const {
  for (int i = 0; i < modify->nfix; ++i)
    if (moves_bodies_of_flow(*modify->fix[i])) return true;
  return false;
}

/// LIGGGHTS marks a fix rigid, but not a fix multisphere, whose group is always all: of a smaller flow
/// none may be part of a body.
bool PfvOtherFixes::moves_bodies_of_flow(const Fix& fix) const {
  if (fix.rigid_flag) return share_grains_with(fix);
  const auto* bodies = dynamic_cast<const FixMultisphere*>(&fix);
  if (!bodies || flow_.igroup == 0) return bodies;
  int any = 0;
  for (int i = 0; i < atom->nlocal && !any; ++i)
    any = (atom->mask[i] & flow_.groupbit) && bodies->belongs_to(i) >= 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

Eigen::Vector3d PfvOtherFixes::gravity() const {
  std::vector<FixGravity*> all;
  for (int i = 0; i < modify->nfix; ++i)
    if (auto* fix = dynamic_cast<FixGravity*>(modify->fix[i])) all.push_back(fix);
  if (all.size() < 2) return sum_of(all, 1).sum;
  if (all.size() > most_fixes_gravity) throw pfv::InputError("there are more than 16 fixes gravity; give the sum of some");
  std::vector<int> occurs(std::size_t{1} << all.size(), 0);  // by the fixes of a grain
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & flow_.groupbit)) continue;
    std::size_t bits = 0;
    for (std::size_t k = 0; k < all.size(); ++k) bits |= std::size_t{(atom->mask[i] & all[k]->groupbit) != 0} << k;
    occurs[bits] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, occurs.data(), static_cast<int>(occurs.size()), MPI_INT, MPI_MAX, world);
  std::optional<Gravity> found;  // without a grain all of them, of grains without any fix none
  for (std::size_t bits = 1; bits < occurs.size(); ++bits) {
    if (!occurs[bits]) continue;
    const Gravity one = sum_of(all, bits);
    if (!found) found = one;
    if (!((one.sum - found->sum).norm() <= 1e-12 * found->sum.norm()))
      throw pfv::InputError("some of its grains have the gravity of " + names_of(all, *found) + ", others that of " +
                            names_of(all, one) + "; the fluid has one: let fix gravity act on all grains alike");
  }
  return found ? found->sum : sum_of(all, occurs.size() - 1).sum;
}

bool PfvOtherFixes::share_grains_with(const Fix& other) const {
  if (other.igroup == flow_.igroup) return true;
  int common = 0;
  for (int i = 0; i < atom->nlocal && !common; ++i)
    common = (atom->mask[i] & flow_.groupbit) && (atom->mask[i] & other.groupbit);
  MPI_Allreduce(MPI_IN_PLACE, &common, 1, MPI_INT, MPI_MAX, world);
  return common != 0;
}

}  // namespace LAMMPS_NS
