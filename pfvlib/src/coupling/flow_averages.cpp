// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities, fluxes and stresses of the last call.
#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"
#include "physics/pore_velocities.hpp"
#include "physics/sphere_stresses.hpp"

namespace pfv {

namespace {

Eigen::Matrix3Xd integrals_of(FlowData& flow) {
  const Balance& balance = flow.balance();
  const BuiltNetwork& built = *flow.built;
  return velocity_integrals(built.network, built.vertices, built.boundaries,
                            balance.throat_fluxes, balance.contact_inflows);
}

void require_axis(int axis) {
  if (axis < 0 || axis > 2)
    throw InputError("axis " + std::to_string(axis) + ": the axes are 0, 1 and 2");
}

}  // namespace

Eigen::Matrix3Xd Flow::pore_velocities() const {
  Eigen::Matrix3Xd velocities = integrals_of(*data_);
  velocities.array().rowwise() /= storage_volumes(data_->built->throats).transpose().array();
  return velocities;
}

Eigen::Matrix3Xd Flow::sphere_velocities() const {
  const Eigen::Matrix3Xd integrals = integrals_of(*data_);
  const BuiltNetwork& built = *data_->built;
  const Eigen::VectorXd volumes = storage_volumes(built.throats);
  const int active = built.grains.spheres.size();
  const SurfacePressure around = built.surface_pressure
                                     ? *built.surface_pressure
                                     : surface_pressure(built.network, built.vertices, built.grains.spheres);
  Eigen::Matrix3Xd result =
      Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(data_->packing_ids.size()));
  for (int sphere = 0; sphere < active; ++sphere) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double volume = 0.0;
    for (int e = around.row_begin[sphere]; e < around.row_begin[sphere + 1]; ++e) {
      sum += around.weight[e] * integrals.col(around.pore[e]);
      volume += around.weight[e] * volumes[around.pore[e]];
    }
    if (volume > 0.0) result.col(built.grains.columns[sphere]) = sum / volume;
  }
  return result;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Flow::sphere_stresses() const {
  data_->require_result();
  const BuiltNetwork& built = *data_->built;
  const int active = built.grains.spheres.size();
  const Stresses stresses =
      pfv::sphere_stresses(built.network, built.throats, built.viscous_shares, built.vertices,
                           data_->pressures, built.grains.spheres,
                           data_->solved_box.pressure_gradient);
  Stresses result = Stresses::Zero(6, static_cast<Eigen::Index>(data_->packing_ids.size()));
  for (int sphere = 0; sphere < active; ++sphere)
    result.col(built.grains.columns[sphere]) = stresses.col(sphere);
  return result;
}

double Flow::plane_flux(int axis, double position) const {
  require_axis(axis);
  const Balance& balance = data_->balance();
  const BuiltNetwork& built = *data_->built;
  const PoreNetwork& network = built.network;
  if (data_->solved_box.periodic[axis])
    throw InputError("the flux through a plane normal to a periodic axis is the superficial velocity "
                     "times the area: see the permeability tensor");
  const double relative = position - network.origin[axis], end = built.grains.spheres.edges[axis];
  if (!(relative >= 0.0 && relative <= end))
    throw InputError("the plane at " + std::to_string(position) + " m is outside the box");
  const auto beyond = [&](int pore) {
    return network.pore_centres(axis, pore) > relative ? 1.0 : 0.0;
  };
  double flux = 0.0;
  for (int t = 0; t < network.throats(); ++t)
    flux += balance.throat_fluxes[t] *
            (beyond(network.throat_pores[t][1]) - beyond(network.throat_pores[t][0]));
  // what enters through the two faces crosses the plane on its way to pores on the other side
  const auto& contacts = built.boundaries.contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].face == 2 * axis) flux += balance.contact_inflows[c] * beyond(contacts[c].pore);
    if (contacts[c].face == 2 * axis + 1)
      flux -= balance.contact_inflows[c] * (1.0 - beyond(contacts[c].pore));
  }
  return flux;
}

SliceMeans Flow::slice_means(int axis, double lower, double upper) const {
  require_axis(axis);
  const Eigen::Matrix3Xd integrals = integrals_of(*data_);
  const BuiltNetwork& built = *data_->built;
  const Eigen::VectorXd volumes = storage_volumes(built.throats);
  SliceMeans means;
  for (int p = 0; p < built.network.pores(); ++p) {
    const double place = built.network.pore_centres(axis, p) + built.network.origin[axis];
    if (!(place >= lower && place < upper)) continue;
    ++means.pores;
    means.volume += volumes[p];
    means.pressure += volumes[p] * data_->pressures[p];
    means.velocity += integrals.col(p);
  }
  if (means.pores == 0)
    throw InputError("no pore has its centre between " + std::to_string(lower) + " and " +
                     std::to_string(upper) + " m");
  means.pressure /= means.volume;
  means.velocity /= means.volume;
  return means;
}

}  // namespace pfv
