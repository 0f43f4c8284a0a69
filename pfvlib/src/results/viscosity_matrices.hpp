// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/report.hpp"
#include "step/built_network.hpp"
#include "step/problem.hpp"

#include <vector>

namespace pfv {

/// The fluid's resistance to the motion of one sphere alone: see Flow::viscosity_matrices. `packed`: spheres in
/// the packing.
std::vector<Eigen::Matrix3d> viscosity_matrices(BuiltNetwork& built, const Problem& problem,
                                                Eigen::Index packed,
                                                const std::vector<int>& columns, Counts& counts);

}  // namespace pfv
