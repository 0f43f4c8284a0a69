// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/network_fields.hpp"

#include "physics/solid_union.hpp"
#include "results/averages.hpp"

#include <vector>

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
  Eigen::VectorXd volumes = (row(built.throats.pore_fluid_volume) + row(doubled)).transpose();
  leave_to_owners(built.share, volumes);
  return volumes;
}

namespace {

/// What a rank draws: its own pores and throats, and behind them the ghosts that these lead to.
struct Drawn {
  std::vector<int> pores, throats;
  int own = 0;                ///< pores that are drawn as such
  std::vector<int> number;    ///< of each pore among those that are drawn
};

Drawn drawn_of(const BuiltNetwork& built) {
  const PoreNetwork& network = built.network;
  Drawn drawn;
  drawn.number.assign(static_cast<std::size_t>(network.pores()), -1);
  const auto take = [&](int pore) {
    if (drawn.number[pore] >= 0) return;
    drawn.number[pore] = static_cast<int>(drawn.pores.size());
    drawn.pores.push_back(pore);
  };
  for (int pore = 0; pore < network.pores(); ++pore)
    if (built.share.owns_pore(pore)) take(pore);
  drawn.own = static_cast<int>(drawn.pores.size());
  for (int t = 0; t < network.throats(); ++t) {
    if (!built.share.owns_pore(network.throat_pores[t][0])) continue;
    drawn.throats.push_back(t);
    take(network.throat_pores[t][1]);
  }
  return drawn;
}

}  // namespace

FieldGrid network_fields(const BuiltNetwork& built, const Solution& solution,
                         const Balance& balance) {
  const PoreNetwork& network = built.network;
  const Drawn drawn = drawn_of(built);
  const auto throats = static_cast<Eigen::Index>(drawn.throats.size());
  FieldGrid grid;
  grid.points = network.pore_centres(Eigen::all, drawn.pores).colwise() + network.origin;
  for (int pore = 0; pore < drawn.own; ++pore) grid.add_cell(FieldGrid::vertex, {pore});
  Eigen::RowVectorXd across(throats);  // mean pressures of the throats
  for (Eigen::Index k = 0; k < throats; ++k) {
    const auto [i, j] = network.throat_pores[drawn.throats[k]];
    grid.add_cell(FieldGrid::line, {drawn.number[i], drawn.number[j]});
    across[k] = 0.5 * (solution.pressures[i] + solution.pressures[j]);
  }
  const Eigen::RowVectorXd pressures = solution.pressures(drawn.pores).transpose();
  const Eigen::RowVectorXd volumes = pore_volumes(built)(drawn.pores).transpose();
  const Eigen::RowVectorXd no_pore = Eigen::RowVectorXd::Zero(drawn.own);
  const Eigen::RowVectorXd no_throat = Eigen::RowVectorXd::Zero(throats);
  grid.of_points = {{"pressure", pressures},
                    {"volume", volumes},
                    {"velocity", pore_velocities(built, balance)(Eigen::all, drawn.pores)}};
  grid.of_cells = {on_cells("pressure", pressures.head(drawn.own), across),
                   on_cells("volume", volumes.head(drawn.own), no_throat),
                   on_cells("conductance", no_pore, row(built.conductances.value)(drawn.throats)),
                   on_cells("flux", no_pore, row(balance.throat_fluxes)(drawn.throats))};
  return grid;
}

}  // namespace pfv
