// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "network/spheres.hpp"
#include "pfv/box.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace pfv {

/// E = dV/dx (thesis eqs. 4.4-4.8), kept cell by cell: the area vectors (m²) that the velocities of a
/// cell's four vertices are multiplied with.
struct VolumeRateMatrix {
  std::vector<std::array<Eigen::Vector3d, 4>> gradient;
};

VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres);

/// dV/dt = E v, m³/s, one entry a pore. `velocities`: 3 x N spheres of the network, m/s; walls move
/// with the face velocities of the box.
Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const PoreNetwork& network,
                             const Eigen::Matrix3Xd& velocities, const Box& box);

/// Base area (m²) of each pore on each of its faces, in the order of `boundaries.contacts`.
std::vector<double> base_areas(const PoreNetwork& network, const PoreBoundaries& boundaries,
                               const Spheres& spheres);

}  // namespace pfv
