// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Mobility of sphere i under a force on sphere j in unbounded fluid, times 6 pi mu, 1/m: Rotne, Prager and
/// Yamakawa's, for unlike spheres that may overlap (Zuk, Wajnryb, Mizerski & Szymczak 2014, Journal of Fluid Mechanics
/// 741, R5).
Eigen::Matrix3d bead_mobility(double one, double other, const Eigen::Vector3d& apart);

/// The drag on each sphere of a rigid body that moves in unbounded fluid without turning, over 6 pi mu times its
/// velocity, m: the rows of the inverse of all mobilities, added up. Two that touch: 1.23 of one sphere's along their
/// axis and 1.39 across together, where it is 1.29 and 1.45. Cost: members³.
std::vector<Eigen::Matrix3d> drags_of_beads(const Spheres& spheres, const std::vector<int>& members);

}  // namespace pfv
