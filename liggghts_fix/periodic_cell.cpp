// SPDX-License-Identifier: GPL-3.0-or-later
#include "periodic_cell.h"

#include "other_fixes.h"

#include "atom.h"
#include "domain.h"
#include "fix_deform.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

namespace LAMMPS_NS {

namespace {

constexpr int remaps_places = 1;  // FixDeform::remapflag; LIGGGHTS' own number, private to its source

}  // namespace

std::array<bool, 3> PfvPeriodicCell::axes() const {
  return {domain->xperiodic != 0, domain->yperiodic != 0, domain->zperiodic != 0};
}

bool PfvPeriodicCell::any() const { return domain->xperiodic || domain->yperiodic || domain->zperiodic; }

Eigen::Vector3d PfvPeriodicCell::lengths() const {
  const auto periodic = axes();
  Eigen::Vector3d lengths = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (periodic[axis]) lengths[axis] = domain->prd[axis];
  return lengths;
}

double PfvPeriodicCell::position(int face) const {
  return face % 2 == 1 ? domain->boxhi[face / 2] : domain->boxlo[face / 2];
}

const FixDeform* PfvPeriodicCell::deforming() const {
  for (int i = 0; i < modify->nfix; ++i)
    if (const auto* deform = dynamic_cast<const FixDeform*>(modify->fix[i])) return deform;
  return nullptr;
}

std::string PfvPeriodicCell::obstacle(int couple_every, bool rigid_bodies) const {
  if (!any()) return {};
  if (domain->triclinic)
    return "the simulation box is tilted (triclinic): LIGGGHTS makes no ghosts for granular atoms in it, so that "
           "contacts across its sides are missing; use an orthogonal box";
  const FixDeform* deform = deforming();
  for (int i = 0; i < modify->nfix; ++i) {
    const Fix& fix = *modify->fix[i];
    if (&fix != deform && (fix.box_change_size || fix.box_change_shape))
      return name_of(fix) + " changes the simulation box, and only what fix deform makes of the grains' places is "
                            "known here; change it with fix deform, or between runs with change_box";
  }
  if (!deform) return {};
  const auto periodic = axes();
  for (int axis = 0; axis < 3; ++axis)
    if (deform->dimflag[axis] && !periodic[axis])
      return name_of(*deform) + " changes the simulation box along " + "xyz"[axis] +
             ", which is not periodic; leave that axis to the walls or meshes there";
  const bool at_flow_steps = couple_every == 0 ? deform->nevery == 1 : couple_every % deform->nevery == 0;
  if (!at_flow_steps)
    return name_of(*deform) + " changes the simulation box every " + std::to_string(deform->nevery) +
           " steps, and flow steps between would see it at rest and then leap; let it change the box at each step, " +
           "or give a couple_every that is a multiple";
  if (rigid_bodies)
    return name_of(*deform) + " changes the simulation box, and rigid bodies do not follow it; use spheres that "
                              "are free";
  return {};
}

PfvCellRates PfvPeriodicCell::rates_since(const std::vector<double>& positions, double elapsed) const {
  PfvCellRates rates{};
  const auto periodic = axes();
  for (int face = 0; face < 6; ++face)
    if (periodic[face / 2]) rates[face] = (position(face) - positions[face]) / elapsed;
  return rates;
}

PfvStreaming PfvPeriodicCell::streaming(const PfvCellRates& rates) const {
  PfvStreaming streaming;
  const FixDeform* deform = deforming();
  if (!deform || deform->remapflag != remaps_places) return streaming;
  streaming.groupbit = deform->groupbit;
  for (int axis = 0; axis < 3; ++axis) {
    streaming.origin[axis] = domain->boxlo[axis];
    streaming.drift[axis] = rates[2 * axis];
    streaming.rate[axis] = (rates[2 * axis + 1] - rates[2 * axis]) / domain->prd[axis];
  }
  return streaming;
}

void PfvPeriodicCell::wrap(Eigen::Matrix3Xd& positions) const {
  const auto periodic = axes();
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic[axis]) continue;
    const double lower = domain->boxlo[axis], upper = domain->boxhi[axis], length = domain->prd[axis];
    for (double& x : positions.row(axis)) {
      if (x < lower) x += length;
      if (x >= upper) x = std::max(x - length, lower);
    }
  }
}

Eigen::Vector3d PfvPeriodicCell::image_near(const Eigen::Vector3d& place, const Eigen::Vector3d& other) const {
  Eigen::Vector3d image = place;
  const auto periodic = axes();
  for (int axis = 0; axis < 3; ++axis)
    if (periodic[axis])
      image[axis] -= domain->prd[axis] * std::round((place[axis] - other[axis]) / domain->prd[axis]);
  return image;
}

Eigen::Vector3d PfvPeriodicCell::periods(int i) const {
  const tagint image = atom->image[i];
  return {static_cast<double>((image & IMGMASK) - IMGMAX),
          static_cast<double>(((image >> IMGBITS) & IMGMASK) - IMGMAX),
          static_cast<double>((image >> IMG2BITS) - IMGMAX)};
}

}  // namespace LAMMPS_NS
