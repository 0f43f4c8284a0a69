// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/report.hpp"
#include "step/built_network.hpp"
#include "step/problem.hpp"

#include <vector>

namespace pfv {

/// The fluid's resistance V^k to the motion of one sphere alone, of which the papers' limit 2 M_k / rho(V^k) is made
/// (thesis eqs. 4.10-4.16, the limit 4.15): see Flow::viscosity_matrices. `packed`: spheres in
/// the packing.
std::vector<Eigen::Matrix3d> viscosity_matrices(BuiltNetwork& built, const Problem& problem,
                                                Eigen::Index packed,
                                                const std::vector<int>& columns, Counts& counts);

}  // namespace pfv
