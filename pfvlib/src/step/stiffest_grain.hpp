// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "step/built_network.hpp"

namespace pfv {

/// FlowModel::stiffest_grain: of the motions of one free grain with one pressure p that they change, the fastest to be
/// braked. With G's diagonal entry g of p and the force s (m²) that a unit of it gives the grain, lambda_max(M^-1 S G^-1 S^T)
/// >= |s|² / (g m), since G^-1 is at least 1/g along p. Needs S and G; `masses` of the packing's spheres, kg. Pores whose
/// pressure pores of other ranks share are left out, and grains of bodies. Collective.
StiffestGrain stiffest_grain_of(const BuiltNetwork& built, const Eigen::VectorXd& masses);

}  // namespace pfv
