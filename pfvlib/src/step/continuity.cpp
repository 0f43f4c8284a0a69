// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/continuity.hpp"

#include "physics/macroscopic_gradient.hpp"
#include "step/operators.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pfv {

double largest_pressure(const BuiltNetwork& built, const Eigen::VectorXd& pressures) {
  return built.share.largest(pressures.size() > 0 ? pressures.cwiseAbs().maxCoeff() : 0.0);
}

Eigen::VectorXd continuity_defect(const BuiltNetwork& built, const Solution& solution) {
  const Unknowns& unknowns = built.unknowns;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(built.network.pores());
  Eigen::VectorXd defect = -pore_inflows(built, solution, throat_fluxes(built, solution, none), none);
  for (std::size_t b = 0; b < unknowns.fed_by.size(); ++b)
    if (const int pore = unknowns.fed_by[b]; pore >= 0)
      defect[pore] += imposed_inflow(solution.container, static_cast<int>(b));
  return defect;
}

namespace {

/// What moves the fluid in each pore, with nothing cancelling: grains and faces, imposed fluxes, the
/// macroscopic gradient and what is stored, m³/s.
Eigen::VectorXd gross_sources(const BuiltNetwork& built, const Solution& solution) {
  const PoreNetwork& network = built.network;
  const Unknowns& unknowns = built.unknowns;
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(network.pores());
  if (solution.moving) gross = gross_rates(built, solution.motion);
  for (std::size_t b = 0; b < unknowns.fed_by.size(); ++b)
    if (const int pore = unknowns.fed_by[b]; pore >= 0)
      gross[pore] += std::abs(imposed_inflow(solution.container, static_cast<int>(b)));
  if (!solution.container.pressure_gradient.isZero(0.0))
    for (int t = 0; t < network.throats(); ++t) {
      const double rate = std::abs(built.conductances.value[t] *
                                   solution.container.pressure_gradient.dot(network.throat_offset(t)));
      for (const int pore : network.throat_pores[t]) gross[pore] += rate;
    }
  if (built.kept.compressible())
    gross.array() += built.kept.storage->array() *
                     (solution.previous_pressures.array() - solution.reference).abs();
  leave_to_owners(built.share, gross);
  return gross;
}

}  // namespace

double rounding_of_pressures(const BuiltNetwork& built, const Solution& solution,
                             std::int64_t& solves) {
  constexpr double round_off = 1e-13;  // some hundred additions a pore
  const Eigen::VectorXd uncancelled =
      homogeneous_pressures(built, gross_sources(built, solution), solves);
  return round_off * largest_pressure(built, uncancelled);
}

Eigen::VectorXd pore_inflows(const BuiltNetwork& built, const Solution& solution,
                             const std::vector<double>& fluxes, const Eigen::VectorXd& correction) {
  const PoreNetwork& network = built.network;
  Eigen::VectorXd inflow = solution.rates;
  if (built.kept.compressible())
    inflow.array() += built.kept.storage->array() *
                      (solution.pressures.array() - solution.previous_pressures.array() +
                       correction.array());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (i == j) continue;  // to its own image: what would cancel here is round-off of a large flux
    inflow[i] += fluxes[t];
    inflow[j] -= fluxes[t];
  }
  leave_to_owners(built.share, inflow);
  return inflow;
}

std::vector<double> throat_fluxes(const BuiltNetwork& built, const Solution& solution,
                                  const Eigen::VectorXd& correction) {
  const PoreNetwork& network = built.network;
  std::vector<double> fluxes(network.throats());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    fluxes[t] =
        built.conductances.value[t] *
        (driving_pressure(network, t, solution.relative_pressures, solution.container.pressure_gradient) +
         (correction[i] - correction[j]));
  }
  return fluxes;
}

Eigen::VectorXd pressure_correction(const BuiltNetwork& built, const Solution& solution,
                                    std::int64_t& solves) {
  constexpr double of_round_off = 1e-6;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(built.network.pores());
  if (!has_unknowns(built)) return none;
  Eigen::VectorXd correction =
      homogeneous_pressures(built, continuity_defect(built, solution), solves);
  const double largest = largest_pressure(built, correction);
  const bool rounding =
      largest <= of_round_off * largest_pressure(built, solution.relative_pressures) ||
      largest <= rounding_of_pressures(built, solution, solves);
  return rounding ? correction : none;
}

}  // namespace pfv
