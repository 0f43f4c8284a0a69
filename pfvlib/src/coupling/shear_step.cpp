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

Eigen::Matrix3Xd FlowData::shear_forces_of(const Eigen::Matrix3Xd& motion) const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, motion.cols());
  if (built->shear_pairs)
    forces.leftCols(motion.cols() - 6) = shear_forces(*built->shear_pairs, fluid.viscosity,
                                                      motion.leftCols(motion.cols() - 6));
  return forces;
}

/// Of the velocities of the packing or, in stages, of their mean over the step: by linearity the mean
/// force.
void FlowData::add_shear_forces(const Packing& packing) {
  if (!moving) return;
  const Eigen::Matrix3Xd of_grains =
      shear_forces_of(mean_motion.cols() > 0 ? mean_motion : motion_of(packing));
  const std::vector<int>& columns = built->grains.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto column = of_grains.col(static_cast<Eigen::Index>(i));
    forces.total.col(columns[i]) += column;
    if (options.split_forces) forces.viscous.col(columns[i]) += column;
  }
}

}  // namespace pfv
