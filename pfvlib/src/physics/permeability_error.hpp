// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/conductances.hpp"
#include "physics/throats.hpp"

#include <optional>
#include <string>
#include <vector>

namespace pfv {

/// How far a permeability can be trusted.
struct PermeabilityError {
  /// K is expected within a factor 1 + relative of Stokes flow; absent where nothing flows.
  std::optional<double> relative;
  std::optional<double> degenerate_share;  ///< of the dissipation, in throats that a rule set
  /// What lies outside the anchors that the estimate was compared with, a phrase each.
  std::vector<std::string> outside_range;
};

/// Estimate for the permeability of a flow that dissipates `dissipation[t]` (any unit) in throat t.
///
/// In a network of resistors d ln K = sum_t w_t d ln g_t, w_t the throat's share of the
/// dissipation. The open-throat law's own error of a throat, whose sign is common to many and does
/// not average out,
///   sigma_t = 0.055 + 0.06 x (1 - x) + 0.05 (wall share) + 0.8 (hidden share),
/// x the drag's share of the resistance (the blend of two limits is the least certain half-way),
/// 0.5 where a rule or the bound sets g. Another law adds 1.05 |sum_t w_t ln(g_t / g_t of the
/// open-throat law)|, 0.05 for what a first-order sum leaves out.
///
/// What throats of spheres that are apart err by on their own averages, over few of them only in part:
///   1.7 (mean x) (standard deviation of ln(mu g / S²)) (sum_t w_t²)^(1/2)
/// is added to the first sum in quadrature; it is 0 in a lattice, and 1.7 was calibrated on beds of 8 to 45 spheres at
/// random in no-slip boxes and cylinders beside a lattice-Boltzmann method (doc/container.md). 0.055 to 0.8 were calibrated on
/// lattices, random beds, the nine-sphere cell and small packings of doc/accuracy.md, which says
/// how often the estimate holds there and on packings made later.
///
/// `solid_fraction` of the bed is compared with that of the anchors. Pure; about 2 µs a throat.
PermeabilityError permeability_error(const PoreNetwork& network, const Throats& throats,
                                     const Spheres& spheres, ConductanceLaw law, double viscosity,
                                     const Conductances& conductances,
                                     const std::vector<double>& dissipation,
                                     double solid_fraction, const Share& share = {});

}  // namespace pfv
