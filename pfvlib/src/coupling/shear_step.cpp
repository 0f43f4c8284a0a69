// SPDX-License-Identifier: GPL-3.0-or-later
// Shear viscous forces in a step.
#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"

namespace pfv {

void FlowData::refuse_shear_forces(Coupling coupling) const {
  if (!options.shear_viscous) return;
  if (box.any_periodic())
    throw InputError("shear viscous forces are not known for periodic axes; switch them off");
  if (coupling == Coupling::implicit)
    throw InputError("shear viscous forces have no implicit step; use the staged coupling");
}

Loads FlowData::shear_forces_of(const Motion& of) const {
  Loads sum = Loads::Zero(6, of.cols());
  const Eigen::Index spheres = spheres_in(of);
  if (built->shear_pairs)
    sum.topLeftCorner(3, spheres) =
        shear_forces(*built->shear_pairs, fluid.viscosity, of.topLeftCorner(3, spheres));
  return sum;
}

/// Of the velocities of the packing or, in stages, of their mean over the step: by linearity the mean
/// force.
void FlowData::add_shear_forces() {
  if (!moving) return;
  const Loads of_grains = shear_forces_of(motion);
  const std::vector<int>& columns = built->grains.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto column = of_grains.col(static_cast<Eigen::Index>(i)).head<3>();
    forces.total.col(columns[i]) += column;
    if (options.split_forces) forces.viscous.col(columns[i]) += column;
  }
}

}  // namespace pfv
