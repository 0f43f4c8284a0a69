// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/packing.hpp"

namespace pfv {

/// Stokes number of a grain, m v / (6 pi mu r^2) = rho_s d v / (9 mu): the way on which a grain of the speed v would be
/// braked by the fluid alone, over its radius.
struct StokesNumbers {
  double largest = 0.0;
  double mean = 0.0;  ///< weighted with the masses
  double mass = 0.0;  ///< kg, of the grains that count
};

/// Two grains that meet with this speed in a viscous fluid do not rebound below some 10: lubrication takes their energy
/// (Davis, Serayssol & Hinch 1986, J. Fluid Mech. 163, 479; Joseph, Zenit, Hunt & Rosenwinkel 2001, J. Fluid Mech. 433,
/// 329). `masses`: kg, of the grains in turn; infinite for one that is held, which does not count, nor do the spheres of
/// rigid bodies. `viscosity`: Pa s. 0 without a grain or without velocities.
StokesNumbers stokes_numbers(const Packing& grains, const Eigen::Ref<const Eigen::VectorXd>& masses, double viscosity);

}  // namespace pfv
