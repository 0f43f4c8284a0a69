// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pfv {

struct Box;
struct FlowData;

/// Fluxes (m³/s) of the last solve from the differences of the pressures and of their correction: summed before the difference
/// is taken, the correction would be rounded away.
std::vector<double> throat_fluxes(const FlowData& flow, const Box& box,
                                  const Eigen::VectorXd& correction);

/// Flow rate (m³/s) into the box through each pore: what its throats carry away, what fills its growing
/// volume and what its compression stores. 0 where nothing is imposed, up to what the solve left.
Eigen::VectorXd pore_inflows(const FlowData& flow, const std::vector<double>& fluxes,
                             const Eigen::VectorXd& correction);

/// What the digits of a double leave out of the pressures (Pa): one solve on the kept factor for the
/// continuity defect, which is exact to the round-off of the fluxes because it is taken from
/// pressure differences. Where a pressure is 1e6 times the differences to its neighbours, the fluxes
/// of the rounded pressures would miss the balance by 1e6 times the machine precision. A lattice whose
/// grains have moved by 1e-5 of their size has pores that close to each other: there the solve itself
/// is 1e-8 off. A correction beyond 1e-6 is no round-off but a solve that went wrong: it is left out,
/// and the balances show it.
Eigen::VectorXd pressure_correction(const FlowData& flow);

}  // namespace pfv
