// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/continuity.hpp"

#include "coupling/flow_data.hpp"
#include "pfv/error.hpp"
#include "solve/solver_abilities.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pfv {

namespace {

/// What is missing in the continuity of each pore, summed over the pores of a flux boundary.
Eigen::VectorXd continuity_defect(const FlowData& flow, const Box& box) {
  const Unknowns& unknowns = flow.built->unknowns;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(flow.built->network.pores());
  Eigen::VectorXd defect = -pore_inflows(flow, throat_fluxes(flow, box, none), none);
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b) {
    const int unknown = unknowns.of_boundary[b];
    if (unknown < 0) continue;
    const auto first = std::find(unknowns.of_pore.begin(), unknowns.of_pore.end(), unknown);
    defect[first - unknowns.of_pore.begin()] += boundary_of(box, static_cast<int>(b)).value;
  }
  return defect;
}

/// What moves the fluid in each pore, with nothing cancelling: grains and faces, imposed fluxes, the
/// macroscopic gradient and what is stored, m³/s.
Eigen::VectorXd gross_sources(const FlowData& flow, const Box& box) {
  const BuiltNetwork& built = *flow.built;
  const PoreNetwork& network = built.network;
  const Unknowns& unknowns = built.unknowns;
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(network.pores());
  if (flow.moving) gross = gross_rates(built, flow.motion);
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b) {
    if (unknowns.of_boundary[b] < 0) continue;
    const auto first = std::find(unknowns.of_pore.begin(), unknowns.of_pore.end(),
                                 unknowns.of_boundary[b]);
    gross[first - unknowns.of_pore.begin()] += std::abs(boundary_of(box, static_cast<int>(b)).value);
  }
  if (!box.pressure_gradient.isZero(0.0))
    for (int t = 0; t < network.throats(); ++t) {
      const double rate = std::abs(built.conductances.value[t] *
                                   box.pressure_gradient.dot(network.throat_offset(t)));
      for (const int pore : network.throat_pores[t]) gross[pore] += rate;
    }
  if (built.storage.size() > 0)
    gross.array() += built.storage.array() * (flow.previous_pressures.array() - flow.reference).abs();
  return gross;
}

/// Pressures below this are round-off (Pa): what the sources' last digits cause. No source causes more
/// than its absolute value does, since the inverse of the matrix has no negative entry. Where grains go
/// along with the fluid all cancels, and the pressures are nothing else. Cost: one solve.
double rounding_of_pressures(const FlowData& flow, const Box& box) {
  constexpr double round_off = 1e-13;  // some hundred additions a pore
  const Eigen::VectorXd uncancelled =
      homogeneous_pressures(*flow.built, gross_sources(flow, box));
  return round_off * uncancelled.cwiseAbs().maxCoeff();
}

}  // namespace

Eigen::VectorXd pore_inflows(const FlowData& flow, const std::vector<double>& fluxes,
                             const Eigen::VectorXd& correction) {
  const PoreNetwork& network = flow.built->network;
  Eigen::VectorXd inflow = flow.rates;
  if (flow.built->storage.size() > 0)
    inflow.array() += flow.built->storage.array() *
                      (flow.pressures.array() - flow.previous_pressures.array() +
                       correction.array());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (i == j) continue;  // to its own image: what would cancel here is round-off of a large flux
    inflow[i] += fluxes[t];
    inflow[j] -= fluxes[t];
  }
  return inflow;
}

std::vector<double> throat_fluxes(const FlowData& flow, const Box& box,
                                  const Eigen::VectorXd& correction) {
  const PoreNetwork& network = flow.built->network;
  std::vector<double> fluxes(network.throats());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    fluxes[t] =
        flow.built->conductances.value[t] *
        (driving_pressure(network, t, flow.relative_pressures, box.pressure_gradient) +
         (correction[i] - correction[j]));
  }
  return fluxes;
}

Eigen::VectorXd pressure_correction(const FlowData& flow) {
  constexpr double of_round_off = 1e-6;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(flow.built->network.pores());
  if (flow.built->unknowns.count == 0) return none;
  Eigen::VectorXd correction =
      homogeneous_pressures(*flow.built, continuity_defect(flow, flow.solved_box));
  const double largest = correction.cwiseAbs().maxCoeff();
  const bool rounding =
      largest <= of_round_off * flow.relative_pressures.cwiseAbs().maxCoeff() ||
      largest <= rounding_of_pressures(flow, flow.solved_box);
  return rounding ? correction : none;
}

void FlowData::refine_pressures(LinearSolver& solver, std::optional<bool>& loses_digits,
                                const std::function<void()>& follow) {
  // A dense packing of 40 000 spheres loses 1.5e-10: that is not worth a second solve at each step.
  constexpr double lost = 1e-9, exact = 1e-10, hopeless = 1e-6;
  constexpr int sweeps = 4;
  if (built->unknowns.count == 0 || is_iterative(options.solver) ||
      options.precision == Precision::mixed || !loses_digits.value_or(true))
    return;
  double last = 0.0;
  std::optional<double> rounding;  // seldom needed
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Eigen::VectorXd correction =
        homogeneous_pressures(*built, solver, continuity_defect(*this, box));
    const double largest = relative_pressures.cwiseAbs().maxCoeff();
    last = correction.cwiseAbs().maxCoeff();
    if (last > exact * largest) {
      if (!rounding) rounding = rounding_of_pressures(*this, box);
      if (last <= *rounding) return;
    }
    if (!loses_digits) loses_digits = last > lost * largest;
    if (!*loses_digits || last <= exact * largest) return;
    relative_pressures += correction;
    pressures = relative_pressures.array() + reference;
    follow();
    last /= largest;
  }
  if (!(last <= hopeless)) throw too_far_apart(*built, fluid);
}

}  // namespace pfv
