// SPDX-License-Identifier: GPL-3.0-or-later
// The permeability of a packing and how far it can be trusted.
#include "physics/macroscopic_gradient.hpp"
#include "physics/permeability_error.hpp"
#include "results/balance.hpp"
#include "step/operators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pfv {

namespace {

/// Superficial velocity (m/s) through a periodic box: the sum over throats of flow rate times the way
/// from pore to pore, over the volume.
Eigen::Vector3d superficial_velocity(const BuiltNetwork& built, const std::vector<double>& fluxes,
                                     double volume) {
  const PoreNetwork& network = built.network;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3);
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (!built.share.owns_pore(i)) continue;
    sum += fluxes[t] * (network.pore_centres.col(j) + network.throat_offset(t) -
                        network.pore_centres.col(i));
  }
  built.share.add(sum);
  return sum / volume;
}

/// -mu U . g / g² for the macroscopic gradient g of a periodic box.
std::optional<double> permeability_along_gradient(const BuiltNetwork& built, double viscosity,
                                                  const Solution& solution,
                                                  const std::vector<double>& fluxes) {
  const Eigen::Vector3d& gradient = solution.container.pressure_gradient;
  const Eigen::Vector3d velocity =
      superficial_velocity(built, fluxes, solution.geometry.volume);
  return -viscosity * velocity.dot(gradient) / gradient.squaredNorm();
}

/// mu Q L / (dp S) between two parallel open faces (method: Darcy's law); absent where the flow is
/// not steady or not one-dimensional.
std::optional<double> permeability(const BuiltNetwork& built, double viscosity,
                                   const Solution& solution, const Totals& totals,
                                   const std::vector<double>& fluxes) {
  if (solution.moving || built.kept.compressible()) return {};
  if (!solution.container.pressure_gradient.isZero(0.0))
    return permeability_along_gradient(built, viscosity, solution, fluxes);
  const std::optional<std::array<int, 2>> faces = faces_of_flow(solution.container);
  if (!faces) return {};
  std::array<double, 2> pressures{0.0, 0.0};
  for (int i = 0; i < 2; ++i) {
    double here = -std::numeric_limits<double>::infinity();  // all of a face are equal
    for (const auto& contact : built.boundaries.contacts)
      if (contact.face == (*faces)[i] && built.share.owns_pore(contact.pore))
        here = solution.relative_pressures[contact.pore];
    pressures[i] = built.share.largest(here);
    if (!std::isfinite(pressures[i])) return {};
  }
  return permeability_of(solution.container, *faces, viscosity, totals, pressures);
}

struct TensorFlow {
  Eigen::Matrix3d permeability = Eigen::Matrix3d::Zero();  ///< m², 0 along axes that are not periodic
  std::vector<double> dissipation;  ///< of each throat, summed over the axes' unit gradients
};

/// Absent without periodic axes, where grains move, and where other faces are open. One solve an axis, on the
/// kept factor, for a unit gradient and no other drive.
std::optional<TensorFlow> tensor_flow(const BuiltNetwork& built, double viscosity,
                                      const Solution& solution, std::int64_t& solves) {
  if (!solution.container.any_periodic() || solution.moving || built.kept.compressible()) return {};
  // a pressure on another face excludes a gradient
  const auto& contacts = built.boundaries.contacts;
  if (built.share.any(std::any_of(contacts.begin(), contacts.end(), [&](const auto& contact) {
        return boundary_of(solution.container, contact.boundary).is_open();
      })))
    return {};
  const PoreNetwork& network = built.network;
  TensorFlow result;
  Eigen::Matrix3d& tensor = result.permeability;
  result.dissipation.assign(network.throats(), 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (!solution.container.periodic[axis]) continue;
    const Eigen::Vector3d gradient = Eigen::Vector3d::Unit(axis);
    const Eigen::VectorXd pressures = homogeneous_pressures(
        built, gradient_sources(built, gradient), solves);
    std::vector<double> fluxes(network.throats());
    for (int t = 0; t < network.throats(); ++t) {
      const double drop = driving_pressure(network, t, pressures, gradient);
      fluxes[t] = built.conductances.value[t] * drop;
      if (built.share.owns_pore(network.throat_pores[t][0])) result.dissipation[t] += fluxes[t] * drop;
    }
    tensor.col(axis) = -viscosity *
                       superficial_velocity(built, fluxes, solution.geometry.volume);
  }
  for (int axis = 0; axis < 3; ++axis)
    if (!solution.container.periodic[axis]) tensor.row(axis).setZero();
  return result;
}

std::vector<double> throat_dissipation(const BuiltNetwork& built, const Solution& solution,
                                       std::vector<double> fluxes) {
  for (int t = 0; t < built.network.throats(); ++t)
    fluxes[t] *= !built.share.owns_pore(built.network.throat_pores[t][0]) ? 0.0 : driving_pressure(built.network, t, solution.relative_pressures,
                                  solution.container.pressure_gradient);
  return fluxes;
}

/// Part of the grains that two walls opposite each other both cut: fluid passes them on no side that the walls leave open.
double share_between_walls(const BuiltNetwork& built) {
  constexpr double round_off = 1e-9;
  const Spheres& spheres = built.grains.spheres;
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(2);
  const auto cuts = [&](int sphere, int wall) {
    return spheres.distance(sphere, wall) < (1.0 - round_off) * spheres.radii[sphere];
  };
  const auto is_between = [&](int sphere) {
    for (int a = 0; a < spheres.wall_count(); ++a)
      for (int b = a + 1; b < spheres.wall_count() && spheres.walls[a].is_plane() && cuts(sphere, a); ++b)
        if (spheres.walls[b].is_plane() && cuts(sphere, b) &&
            spheres.walls[a].surface.normal.dot(spheres.walls[b].surface.normal) < -1.0 + round_off)
          return true;
    return false;
  };
  for (int sphere = 0; sphere < spheres.size(); ++sphere) {
    if (!built.share.owns_sphere(sphere)) continue;
    ++counts[1];
    if (is_between(sphere)) ++counts[0];
  }
  built.share.add(counts);
  return counts[1] > 0.0 ? counts[0] / counts[1] : 0.0;
}

/// Whether a rule closed a throat that has an opening.
bool closes_open_throats(const BuiltNetwork& built) {
  bool any = false;
  for (int t = 0; t < built.network.throats() && !any; ++t)
    any = built.conductances.value[t] <= 0.0 && !is_closed(built.throats, t);
  return built.share.any(any);
}

void add_error(Report& report, const BuiltNetwork& built, const Problem& problem,
               const std::vector<double>& dissipation) {
  PermeabilityError error = permeability_error(
      built.network, built.throats, built.vertices, problem.options.conductance,
      problem.fluid.viscosity, built.conductances, dissipation, 1.0 - report.porosity, built.share);
  report.permeability_error = error.relative;
  report.degenerate_share = error.degenerate_share;
  report.outside_range = std::move(error.outside_range);
  const double between = share_between_walls(built);
  if (between == 0.0) return;
  char text[140];
  std::snprintf(text, sizeof text, "grains that are cut by two opposite faces make up, of all grains, %.3g %% (compared "
                "with none: grains must fit between the faces)", 100.0 * between);
  report.outside_range.emplace_back(text);
  if (closes_open_throats(built)) report.permeability_error.reset();
}

}  // namespace

void add_permeability(Report& report, const BuiltNetwork& built, const Problem& problem,
                      const Solution& solution, const Totals& totals,
                      const std::vector<double>& fluxes, std::int64_t& solves) {
  const double viscosity = problem.fluid.viscosity;
  report.permeability = permeability(built, viscosity, solution, totals, fluxes);
  const std::optional<TensorFlow> tensor = tensor_flow(built, viscosity, solution, solves);
  if (tensor) report.permeability_tensor = tensor->permeability;
  if (report.permeability)
    add_error(report, built, problem, throat_dissipation(built, solution, fluxes));
  else if (tensor)
    add_error(report, built, problem, tensor->dissipation);
}

}  // namespace pfv
