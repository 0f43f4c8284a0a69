// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/share.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

struct Conductances;
struct PoreNetwork;

/// By how much the pores have changed their volumes since the network was built: the larger of two means of
/// |changes| / volumes, one weighted with the volumes, one with the power that the fluid loses in the throats of
/// each pore. The first is that of the pore space. The second sees the few pores through which all fluid passes,
/// say those before an outlet: conductances that change by parts x_t change the resistance to the flow by the
/// mean of x_t weighted with the power, to first order. On several ranks over the pores of all; collective. `changes`, `volumes`: m³, an entry a pore; `volumes` > 0.
double mean_pore_strain(const PoreNetwork& network, const Conductances& conductances,
                        const Eigen::VectorXd& pressures, const Eigen::Vector3d& gradient,
                        const Eigen::VectorXd& changes, const std::vector<double>& volumes, const Share& share = {});

}  // namespace pfv
