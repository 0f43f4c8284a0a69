// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "physics/force_matrix.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>

namespace pfv {

/// xx, yy, zz, xy, xz, yz: LIGGGHTS' order. Tension is positive, Pa.
using Stresses = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Mean stress that the fluid causes in each sphere, one column a sphere: the moment of its
/// tractions about the centre over the sphere's volume, symmetric part (the solid's share of thesis
/// eq. 2.18). The pressure of each pore acts on the sphere's surface in its cells, exactly; the
/// viscous force of a throat, shared as in the force matrix, acts where the line to the facet's
/// middle leaves the sphere. In an even pressure p the result is -p times unity. `vertices` may be
/// images of `spheres` along periodic axes; around an image the pressure stands higher by
/// `gradient` (Pa/m) times its offset. Cost: one pass over cells and facets.
Stresses sphere_stresses(const PoreNetwork& network, const Throats& throats,
                         const ViscousShares& shares, const Spheres& vertices,
                         const Eigen::VectorXd& pressures, const Spheres& spheres,
                         const Eigen::Vector3d& gradient);

}  // namespace pfv
