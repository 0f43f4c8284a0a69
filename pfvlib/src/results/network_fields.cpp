// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/network_fields.hpp"

#include "physics/solid_union.hpp"
#include "results/averages.hpp"

namespace pfv {

namespace {

Eigen::RowVectorXd row(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::RowVectorXd>(values.data(),
                                              static_cast<Eigen::Index>(values.size()));
}

/// Cells are pores, then throats; what only one of them has is 0 for the other.
Field on_cells(const char* name, const Eigen::RowVectorXd& of_pores,
               const Eigen::RowVectorXd& of_throats) {
  Eigen::RowVectorXd values(of_pores.size() + of_throats.size());
  values << of_pores, of_throats;
  return {name, values};
}

}  // namespace

Eigen::VectorXd pore_volumes(const BuiltNetwork& built) {
  const std::vector<double> doubled = doubled_volumes(built.network, built.vertices, built.grains.spheres);
  return (row(built.throats.pore_fluid_volume) + row(doubled)).transpose();
}

FieldGrid network_fields(const BuiltNetwork& built, const Solution& solution,
                         const Balance& balance) {
  const PoreNetwork& network = built.network;
  FieldGrid grid;
  grid.points = network.pore_centres.colwise() + network.origin;
  for (int pore = 0; pore < network.pores(); ++pore) grid.add_cell(FieldGrid::vertex, {pore});
  Eigen::RowVectorXd across(network.throats());  // mean pressures of the throats
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    grid.add_cell(FieldGrid::line, {i, j});
    across[t] = 0.5 * (solution.pressures[i] + solution.pressures[j]);
  }
  const Eigen::RowVectorXd pressures = solution.pressures.transpose();
  const Eigen::RowVectorXd volumes = pore_volumes(built).transpose();
  const Eigen::RowVectorXd no_pore = Eigen::RowVectorXd::Zero(network.pores());
  const Eigen::RowVectorXd no_throat = Eigen::RowVectorXd::Zero(network.throats());
  grid.of_points = {{"pressure", pressures},
                    {"volume", volumes},
                    {"velocity", pore_velocities(built, balance)}};
  grid.of_cells = {on_cells("pressure", pressures, across),
                   on_cells("volume", volumes, no_throat),
                   on_cells("conductance", no_pore, row(built.conductances.value)),
                   on_cells("flux", no_pore, row(balance.throat_fluxes))};
  return grid;
}

}  // namespace pfv
