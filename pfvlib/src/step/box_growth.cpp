// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/box_growth.hpp"

#include "physics/cell_stretching.hpp"

namespace pfv {

BoxGrowth growth_of(const Container& container, const ContainerGeometry& present, const BuiltNetwork& built,
                    double ahead) {
  const Matrix6Xd& as_built = built.geometry.loads;
  const Matrix6Xd now = present.loads - as_built;
  if (!any_face_moves(container)) return {now, now};
  if (stretches(container)) {  // three lengths may change: Simpson's rule, exact for areas that are squares in time
    const Matrix6Xd middle = geometry_after(container, ahead, built.network.origin).loads;
    const Matrix6Xd other_end = geometry_after(container, 2.0 * ahead, built.network.origin).loads;
    return {(present.loads + 4.0 * middle + other_end) / 6.0 - as_built, now};
  }
  return {geometry_after(container, ahead, built.network.origin).loads - as_built, now};
}

double rate_beyond(const BoxGrowth& growth, const Motion& motion) {
  const Eigen::Index faces = growth.in_the_middle.cols(), spheres = motion.cols() - faces;
  double rate = 0.0;
  for (Eigen::Index f = 0; f < faces; ++f)
    rate += growth.in_the_middle.col(f).dot(motion.col(spheres + f));
  return rate;
}

void spread_over_pores(double rate, const BuiltNetwork& built, Eigen::VectorXd& rates) {
  if (rate == 0.0) return;
  const Eigen::Map<const Eigen::VectorXd> volumes(built.throats.pore_volume.data(), rates.size());
  rates += rate / built.share.sum(volumes.sum()) * volumes;
}

Matrix6Xd forces_on_growth(const BoxGrowth& growth, const BuiltNetwork& built, const Eigen::VectorXd& pressures) {
  const Eigen::Map<const Eigen::VectorXd> volumes(built.throats.pore_volume.data(), pressures.size());
  if (growth.now.isZero(0.0)) return Matrix6Xd::Zero(6, growth.now.cols());
  const double volume = built.share.sum(volumes.sum()), sum = built.share.sum(volumes.dot(pressures));
  return (volume > 0.0 ? sum / volume : 0.0) * growth.now;
}

}  // namespace pfv
