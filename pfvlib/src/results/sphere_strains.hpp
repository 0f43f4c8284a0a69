// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow.hpp"
#include "step/built_network.hpp"

#include <vector>

namespace pfv {

/// See Flow::sphere_strains. `cell`: the container as it is now; `packed`: spheres in the packing.
Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_strains(const BuiltNetwork& built, const Container& cell,
                                                        const Displaced& moved, Eigen::Index packed);

/// See Flow::strain_fields.
std::vector<Field> strain_fields(Eigen::Matrix<double, 6, Eigen::Dynamic> strains);

}  // namespace pfv
