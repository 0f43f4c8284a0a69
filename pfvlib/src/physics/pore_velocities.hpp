// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Middle of a facet's polygon: of a triangle of centres, of the trapezoid or rectangle with walls.
Eigen::Vector3d facet_middle(const std::array<Vertex, 3>& facet, const Spheres& spheres);

/// V u of each pore (m⁴/s): the integral of the fluid's velocity over it, relative to the grains. By the
/// divergence theorem it is the sum over its sides of the flow rate out of it times the way from the
/// pore's middle to that of the side, exact for an even flow, and the sum over all pores of a box with
/// steady flow is Q L. `fluxes`: of the throats; `inflows`: of `boundaries.contacts`, m³/s.
Eigen::Matrix3Xd velocity_integrals(const PoreNetwork& network, const Spheres& spheres,
                                    const PoreBoundaries& boundaries,
                                    const std::vector<double>& fluxes,
                                    const std::vector<double>& inflows);

}  // namespace pfv
