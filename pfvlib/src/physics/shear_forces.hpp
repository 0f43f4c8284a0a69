// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Two spheres that share a facet of the power diagram: what the fluid between them resists when they
/// slide past each other.
struct ShearPair {
  int first, second;          ///< columns of the spheres
  double area;                ///< S: of the shared facet, m²
  double hydraulic_radius;    ///< R_h of the throats around the pair, sum of phi over sum of gamma, m
  Eigen::Vector3d direction;  ///< unit vector from the first centre to the second
};

/// All pairs with an area and a hydraulic radius > 0. Pure; cost: one pass over the facets and a sort.
/// Not for periodic boxes, whose facets join images.
std::vector<ShearPair> shear_pairs(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres);

/// What a pair resists relative velocities with, kg/s: mu / R_h S across its direction, none along it.
Eigen::Matrix3d resistance_of(const ShearPair& pair, double viscosity);

/// Shear viscous forces (Catalano 2012 eqs. 6.29-6.30): mu / R_h S times the tangential relative velocity
/// of the centres, 3 x N, N. Each pair is an action and its reaction along the sliding; walls take none
/// and nothing turns.
Eigen::Matrix3Xd shear_forces(const std::vector<ShearPair>& pairs, double viscosity,
                              const Eigen::Ref<const Eigen::Matrix3Xd>& velocities);

}  // namespace pfv
