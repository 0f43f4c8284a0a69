// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "parallel/share.hpp"
#include "physics/resistance.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Two spheres that share a facet of the power diagram: what the fluid between them resists when they
/// slide past each other. In periodic boxes the second may stand for one of its images.
struct ShearPair {
  int first, second;          ///< columns of the spheres
  Eigen::Vector3i periods;    ///< by which that image stands beside the second
  double area;                ///< S: of the shared facet, m²
  double hydraulic_radius;    ///< R_h of the throats around the pair, sum of phi over sum of gamma; at a body of
                              ///< those around all its spheres there, m
  Eigen::Vector3d direction;  ///< unit vector from the first centre to the second
};

/// All pairs with an area and a hydraulic radius > 0, each once; none of a sphere with its own images or with others of
/// its body, which move as it does. `vertices`: what the network's vertices stand for; `body`: of each sphere, -1 for
/// none, empty where there are no bodies on any rank. Cost: one pass over the facets and a sort; collective where several
/// ranks (`share`) have bodies.
std::vector<ShearPair> shear_pairs(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                                   const Spheres& vertices, const std::vector<int>& body = {}, const Share& share = {});

/// Adds R of these pairs: mu / R_h S across the direction of each, none along it.
void add_blocks(const std::vector<ShearPair>& pairs, double viscosity, std::vector<ResistanceBlock>& blocks);

/// Shear viscous forces (Catalano 2012 eqs. 6.29-6.30): mu / R_h S times the tangential relative velocity
/// of the centres, 3 x N, N. Each pair is an action and its reaction along the sliding; walls take none
/// and nothing turns. `of_periods`: how much faster an image moves than its sphere, one column for a period along
/// each axis, m/s.
Eigen::Matrix3Xd shear_forces(const std::vector<ShearPair>& pairs, double viscosity,
                              const Eigen::Ref<const Eigen::Matrix3Xd>& velocities,
                              const Eigen::Matrix3d& of_periods = Eigen::Matrix3d::Zero());

}  // namespace pfv
