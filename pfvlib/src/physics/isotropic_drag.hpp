// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

/// Solid fraction around each sphere: that of the domains of its throats, weighed by the solid angle in which it sees
/// each; 1 for a sphere without any. Pure; cost: a pass over the facets.
std::vector<double> solid_fractions_around(const PoreNetwork& network, const Throats& throats,
                                           const Spheres& vertices);

/// Solid fraction below which a sphere stands in open water.
inline constexpr double open_fraction = 0.2;

/// Makes the drag of a sphere that stands alone, with none but walls and its own images around it, the same in every
/// direction. By the open-throat law it is braked by
///
///     9/2 mu r sum Omega_f n_f n_f^T
///
/// over the facets f around it, seen under the solid angles Omega_f (4 pi in all): Stokes' drag as a mean over the
/// directions, but twice as much along one as along another where few facets stand around it askew. The resistance
/// of each facet is multiplied with s = n^T B n, B the symmetric matrix nearest to 1 for which the sum is 6 pi mu r;
/// a throat takes the mean over its solid surface, no-slip walls counting for 1. Lattices keep theirs, and so does
/// what is denser than `open_fraction`. `conductances`: of each throat, by the open-throat law. Cost: as above.
void make_drag_isotropic(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                         std::vector<double>& conductances);

}  // namespace pfv
