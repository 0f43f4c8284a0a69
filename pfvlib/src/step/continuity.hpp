// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/built_network.hpp"
#include "step/solution.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pfv {

/// Fluxes (m³/s) from the differences of the pressures and of their correction: summed before the difference
/// is taken, the correction would be rounded away.
std::vector<double> throat_fluxes(const BuiltNetwork& built, const Solution& solution,
                                  const Eigen::VectorXd& correction);

/// Flow rate (m³/s) into the box through each pore, sum_j q_ij + dV_i/dt + V^f (p - p_old) / (K_f dt): what its throats
/// carry away, what fills its growing volume and what its compression stores. 0 where nothing is imposed, up to what
/// the solve left.
Eigen::VectorXd pore_inflows(const BuiltNetwork& built, const Solution& solution,
                             const std::vector<double>& fluxes, const Eigen::VectorXd& correction);

/// Over all ranks, Pa.
double largest_pressure(const BuiltNetwork& built, const Eigen::VectorXd& pressures);

/// What is missing in the continuity of each pore, m³/s, summed over the pores of a flux boundary.
Eigen::VectorXd continuity_defect(const BuiltNetwork& built, const Solution& solution);

/// Pressures below this are round-off (Pa): what the sources' last digits cause. No source causes more
/// than its absolute value does, since the inverse of the matrix has no negative entry. Where grains go
/// along with the fluid all cancels, and the pressures are nothing else. Cost: one solve.
double rounding_of_pressures(const BuiltNetwork& built, const Solution& solution,
                             std::int64_t& solves);

/// What the digits of a double leave out of the pressures (Pa): one solve on the kept factor for the
/// continuity defect, which is exact to the round-off of the fluxes because it is taken from
/// pressure differences. Where a pressure is 1e6 times the differences to its neighbours, the fluxes
/// of the rounded pressures would miss the balance by 1e6 times the machine precision. A lattice whose
/// grains have moved by 1e-5 of their size has pores that close to each other: there the solve itself
/// is 1e-8 off. A correction beyond 1e-6 is no round-off but a solve that went wrong: it is left out,
/// and the balances show it.
Eigen::VectorXd pressure_correction(const BuiltNetwork& built, const Solution& solution,
                                    std::int64_t& solves);

}  // namespace pfv
