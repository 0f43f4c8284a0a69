// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/network.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Pressure difference that drives a throat from its first pore to its second, Pa: along periodic axes
/// the second pore's image stands offset . gradient higher.
double driving_pressure(const PoreNetwork& network, int throat, const Eigen::VectorXd& pressures,
                        const Eigen::Vector3d& gradient);

/// What a macroscopic gradient (Pa/m) drives into each pore, m³/s.
Eigen::VectorXd gradient_sources(const PoreNetwork& network,
                                 const std::vector<double>& conductances,
                                 const Eigen::Vector3d& gradient);

}  // namespace pfv
