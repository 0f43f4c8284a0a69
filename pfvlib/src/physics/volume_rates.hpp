// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "network/spheres.hpp"
#include "parallel/team.hpp"
#include "pfv/box.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// E = dV/dx (thesis eqs. 4.4-4.8) in compressed rows, one a pore: the area vectors (m²) that the
/// velocities of spheres and walls are multiplied with.
struct VolumeRateMatrix {
  std::vector<int> row_begin{0};
  std::vector<Vertex> mover;  ///< the sphere, or the wall
  Eigen::Matrix3Xd area;

  int rows() const { return static_cast<int>(row_begin.size()) - 1; }
};

VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres);

/// dV/dt = E v, m³/s, one entry a pore. `velocities`: 3 x N spheres of the network, m/s; walls move
/// with the face velocities of the box.
void volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& velocities,
                  const Box& box, Team& team, Eigen::VectorXd& rates);
Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& velocities,
                             const Box& box);
/// The same for given velocities of the walls: 3 x (N + 6), the last six those of xlo ... zhi.
Eigen::VectorXd volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& motion);
/// What those are summed from, m³/s: sums of |area||velocity|. The rates are exact to their round-off.
Eigen::VectorXd gross_volume_rates(const VolumeRateMatrix& matrix, const Eigen::Matrix3Xd& motion);
/// Velocities (m/s) of the spheres followed by those of the six faces: 3 x (N + 6).
Eigen::Matrix3Xd with_face_velocities(const Eigen::Matrix3Xd& velocities, const Box& box);

/// Base area (m²) of each pore on each of its faces, in the order of `boundaries.contacts`.
std::vector<double> base_areas(const PoreNetwork& network, const PoreBoundaries& boundaries,
                               const Spheres& spheres);

}  // namespace pfv
