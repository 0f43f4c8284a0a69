// SPDX-License-Identifier: GPL-3.0-or-later
// A network is kept while the box changes: volumes and forces that follow the box as it is.
#include "coupling/flow_data.hpp"

namespace pfv {

namespace {

/// Of the faces normal to each axis, m².
Eigen::Vector3d areas_of(const Eigen::Vector3d& edges) {
  return {edges[1] * edges[2], edges[2] * edges[0], edges[0] * edges[1]};
}

}  // namespace

/// `ahead`, s: from now to the middle of the step that the velocities belong to. With the areas of the middle
/// the faces sweep just what the box's volume changes by.
void FlowData::measure_grown_areas(double ahead) {
  Eigen::Vector3d edges = box.upper - box.lower;
  const Eigen::Vector3d& as_built = built->grains.spheres.edges;
  grown_areas_now = areas_of(edges) - areas_of(as_built);
  for (int axis = 0; axis < 3; ++axis)
    edges[axis] += ahead * (box.faces[2 * axis + 1].velocity - box.faces[2 * axis].velocity);
  grown_areas = areas_of(edges) - areas_of(as_built);
}

/// What the box grows by beyond the rates of the network as it was built, m³/s.
double FlowData::growth_beyond_rates(const Motion& of) const {
  double rate = 0.0;
  for (int face = 0; face < 6; ++face)
    rate += (face % 2 ? 1.0 : -1.0) * grown_areas[face / 2] *
            of(face / 2, spheres_in(of) + face);
  return rate;
}

/// All cells have grown alike where the box has: each takes its part by volume.
void FlowData::spread_over_pores(double rate) {
  if (rate == 0.0) return;
  const Eigen::Map<const Eigen::VectorXd> volumes(built->throats.pore_volume.data(), rates.size());
  rates += rate / volumes.sum() * volumes;
}

/// The transpose of that: the mean pressure on the growth, so that faces feel the pressures on their
/// present areas and the fluid does on the faces the work that they do on it.
Eigen::Vector3d FlowData::forces_on_growth() const {
  const Eigen::Map<const Eigen::VectorXd> volumes(built->throats.pore_volume.data(),
                                                  relative_pressures.size());
  if (grown_areas_now.isZero(0.0) || volumes.size() == 0) return Eigen::Vector3d::Zero();
  return volumes.dot(relative_pressures) / volumes.sum() * grown_areas_now;
}

/// S p and the pressures on the faces as they are now.
Loads FlowData::pressure_loads() const {
  Loads sum = loads_of(*built, relative_pressures);
  const Eigen::Vector3d growth = forces_on_growth();
  for (int face = 0; face < 6; ++face)
    sum(face / 2, spheres_in(sum) + face) += (face % 2 ? 1.0 : -1.0) * growth[face / 2];
  return sum;
}

}  // namespace pfv
