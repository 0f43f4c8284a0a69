// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "parallel/share.hpp"
#include "physics/conductances.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

/// Re = rho (|q| / S) d / mu of the throats: the velocity over the whole area of the throat, as in Darcy's law, and the
/// mean diameter d of the spheres around it. Stokes flow, and with it every law of a throat's conductance, holds below
/// 1 or so; the resistance of a dense bed is some 6 % higher at 3 and 20 % at 10 (Ergun 1952: by 1.75 Re / (150 (1 - n))).
struct ReynoldsNumbers {
  double largest = 0.0;
  double mean = 0.0;  ///< weighted with the power that is lost in each throat
};

/// `fluxes`: m³/s, one a throat; `density` in kg/m³, `viscosity` in Pa s. Collective where ranks share the network; a
/// throat counts at the owner of its first pore. Pure; a pass over the throats.
ReynoldsNumbers reynolds_numbers(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                                 const Conductances& conductances, const std::vector<double>& fluxes, double density,
                                 double viscosity, const Share& share = {});

}  // namespace pfv
