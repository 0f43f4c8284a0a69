// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/report.hpp"
#include "results/balance_terms.hpp"
#include "step/problem.hpp"
#include "step/solution.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace pfv {

/// What follows from the pressures of a solution for the throats and the faces. A step does not need
/// it, so it is made when asked for.
struct Balance {
  Eigen::VectorXd correction;           ///< to the pressures, beyond the digits of a double, Pa
  std::vector<double> throat_fluxes;    ///< from the first pore of a throat to its second, m³/s
  std::vector<double> contact_inflows;  ///< into the box through each boundary contact, m³/s
  std::vector<FaceResult> faces;
};

/// Fluxes of throats and faces (through a face: the sum of pore_inflows over its pores), forces on the faces.
/// Cost: one solve, counted in `solves`, and a pass over the throats.
Balance balance_of(const BuiltNetwork& built, const Solution& solution, std::int64_t& solves);

/// What each boundary is made of.
std::vector<BoundaryPart> boundary_parts(const BuiltNetwork& built, const Solution& solution,
                                         const std::vector<double>& inflows);

/// What the throats would carry and the pores store if pressures did not cancel, and what the grains
/// displace: fluxes below the machine precision of this are round-off, not flow, m³/s.
double traffic(const BuiltNetwork& built, const Solution& solution);

/// Sum of the forces on spheres and faces, over what `balance_terms` says; 0 without forces.
double force_balance_error(const BuiltNetwork& built, const Solution& solution,
                           const std::vector<FaceResult>& faces);

/// Permeability and tensor with their estimated error, where they have a meaning; `report` holds the
/// porosity already. Cost: a solve for each periodic axis, counted in `solves`.
void add_permeability(Report& report, const BuiltNetwork& built, const Problem& problem,
                      const Solution& solution, const Totals& totals,
                      const std::vector<double>& fluxes, std::int64_t& solves);

}  // namespace pfv
