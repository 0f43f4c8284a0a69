// SPDX-License-Identifier: GPL-3.0-or-later
// The permeability of a packing and how far it can be trusted.
#include "coupling/balance_terms.hpp"
#include "coupling/flow_data.hpp"
#include "physics/permeability_error.hpp"

#include <array>
#include <cmath>

namespace pfv {

namespace {

/// Superficial velocity (m/s) through a periodic box: the sum over throats of flow rate times the way
/// from pore to pore, over the volume.
Eigen::Vector3d superficial_velocity(const PoreNetwork& network, const std::vector<double>& fluxes,
                                     double volume) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    sum += fluxes[t] * (network.pore_centres.col(j) + network.throat_offset(t) -
                        network.pore_centres.col(i));
  }
  return sum / volume;
}

/// -mu U . g / g² for the macroscopic gradient g of a periodic box.
std::optional<double> permeability_along_gradient(const FlowData& flow,
                                                  const std::vector<double>& fluxes) {
  const Eigen::Vector3d& gradient = flow.solved_box.pressure_gradient;
  const Eigen::Vector3d velocity =
      superficial_velocity(flow.built->network, fluxes, flow.solved_box.volume());
  return -flow.fluid.viscosity * velocity.dot(gradient) / gradient.squaredNorm();
}

/// mu Q L / (dp S) between two opposite open faces (method: Darcy's law); absent where the flow is
/// not steady or not one-dimensional.
std::optional<double> permeability(const FlowData& flow, const Totals& totals,
                                   const std::vector<double>& fluxes) {
  if (flow.moving || flow.built->storage.size() > 0) return {};
  if (!flow.solved_box.pressure_gradient.isZero(0.0))
    return permeability_along_gradient(flow, fluxes);
  const std::optional<int> axis = axis_of_flow(flow.solved_box);
  if (!axis) return {};
  std::array<double, 2> pressure{0.0, 0.0};
  for (const auto& contact : flow.built->boundaries.contacts)
    if (contact.face / 2 == *axis)
      pressure[contact.face % 2] = flow.relative_pressures[contact.pore];
  return permeability_of(flow.solved_box, *axis, flow.fluid.viscosity, totals,
                         std::abs(pressure[0] - pressure[1]));
}

struct TensorFlow {
  Eigen::Matrix3d permeability = Eigen::Matrix3d::Zero();  ///< m², 0 along axes that are not periodic
  std::vector<double> dissipation;  ///< of each throat, summed over the axes' unit gradients
};

/// Absent without periodic axes, where grains move, and where other faces are open. One solve an axis, on the kept factor, for a unit gradient and no other drive.
std::optional<TensorFlow> tensor_flow(const FlowData& flow) {
  if (!flow.solved_box.any_periodic() || flow.moving || flow.built->storage.size() > 0) return {};
  // a pressure on another face excludes a gradient
  for (const auto& contact : flow.built->boundaries.contacts)
    if (boundary_of(flow.solved_box, contact.boundary).is_open()) return {};
  const BuiltNetwork& built = *flow.built;
  const PoreNetwork& network = built.network;
  TensorFlow result;
  Eigen::Matrix3d& tensor = result.permeability;
  result.dissipation.assign(network.throats(), 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (!flow.solved_box.periodic[axis]) continue;
    const Eigen::Vector3d gradient = Eigen::Vector3d::Unit(axis);
    const Eigen::VectorXd pressures = homogeneous_pressures(
        built, gradient_sources(network, built.conductances.value, gradient));
    std::vector<double> fluxes(network.throats());
    for (int t = 0; t < network.throats(); ++t) {
      const double drop = driving_pressure(network, t, pressures, gradient);
      fluxes[t] = built.conductances.value[t] * drop;
      result.dissipation[t] += fluxes[t] * drop;
    }
    tensor.col(axis) = -flow.fluid.viscosity *
                       superficial_velocity(network, fluxes, flow.solved_box.volume());
  }
  for (int axis = 0; axis < 3; ++axis)
    if (!flow.solved_box.periodic[axis]) tensor.row(axis).setZero();
  return result;
}

std::vector<double> throat_dissipation(const FlowData& flow, std::vector<double> fluxes) {
  for (int t = 0; t < flow.built->network.throats(); ++t)
    fluxes[t] *= driving_pressure(flow.built->network, t, flow.relative_pressures,
                                  flow.solved_box.pressure_gradient);
  return fluxes;
}

void add_error(Report& report, const FlowData& flow, const std::vector<double>& dissipation) {
  const BuiltNetwork& built = *flow.built;
  PermeabilityError error = permeability_error(
      built.network, built.throats, built.vertices, flow.options.conductance,
      flow.fluid.viscosity, built.conductances, dissipation, 1.0 - report.porosity);
  report.permeability_error = error.relative;
  report.degenerate_share = error.degenerate_share;
  report.outside_range = std::move(error.outside_range);
}

}  // namespace

void add_permeability(Report& report, const FlowData& flow, const Totals& totals,
                      const std::vector<double>& fluxes) {
  report.permeability = permeability(flow, totals, fluxes);
  const std::optional<TensorFlow> tensor = tensor_flow(flow);
  if (tensor) report.permeability_tensor = tensor->permeability;
  if (report.permeability)
    add_error(report, flow, throat_dissipation(flow, fluxes));
  else if (tensor)
    add_error(report, flow, tensor->dissipation);
}

}  // namespace pfv
