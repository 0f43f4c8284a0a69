// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/box_growth.hpp"

namespace pfv {

namespace {

Eigen::VectorXd areas_of(const Eigen::Vector3d& edges) {
  Eigen::VectorXd areas(static_cast<Eigen::Index>(all_faces.size()));
  for (const Face face : all_faces) {
    const int axis = axis_of(face);
    areas[static_cast<int>(face)] = edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
  }
  return areas;
}

}  // namespace

BoxGrowth growth_of(const Box& box, const Eigen::Vector3d& edges_as_built, double ahead) {
  const Eigen::VectorXd as_built = areas_of(edges_as_built);
  Eigen::Vector3d edges = box.upper - box.lower;
  BoxGrowth growth;
  growth.now = areas_of(edges) - as_built;
  Eigen::Vector3d stretching = Eigen::Vector3d::Zero();
  for (const Face face : all_faces) stretching += box[face].velocity * outward_normal(face);
  edges += ahead * stretching;
  growth.in_the_middle = areas_of(edges) - as_built;
  return growth;
}

double rate_beyond(const BoxGrowth& growth, const Motion& motion) {
  double rate = 0.0;
  for (const Face face : all_faces) {
    const auto f = static_cast<Eigen::Index>(face);
    const auto velocity = motion.col(spheres_in(motion) + f).head<3>();
    rate += growth.in_the_middle[f] * outward_normal(face).dot(velocity);
  }
  return rate;
}

void spread_over_pores(double rate, const Throats& throats, Eigen::VectorXd& rates) {
  if (rate == 0.0) return;
  const Eigen::Map<const Eigen::VectorXd> volumes(throats.pore_volume.data(), rates.size());
  rates += rate / volumes.sum() * volumes;
}

Eigen::VectorXd forces_on_growth(const BoxGrowth& growth, const Throats& throats,
                                 const Eigen::VectorXd& pressures) {
  const Eigen::Map<const Eigen::VectorXd> volumes(throats.pore_volume.data(), pressures.size());
  if (growth.now.isZero(0.0) || volumes.size() == 0) return Eigen::VectorXd::Zero(growth.now.size());
  return volumes.dot(pressures) / volumes.sum() * growth.now;
}

}  // namespace pfv
