// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "network/spheres.hpp"
#include "parallel/team.hpp"
#include "pfv/network.hpp"
#include "physics/force_matrix.hpp"
#include "physics/rigid_motion.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

// dV/dt of each pore from the velocities of spheres and faces.
//
// The fluid part of a facet moves with what drags it: dV/dt = S^T v, the transpose of the forces F = S p, as
// Stokes flow demands (Lorentz' reciprocal theorem), and a face's base with the face. Over all pores it adds
// up to the rate of the box's volume; moving all together, turning included, gives 0. The papers take the
// derivative of the tetrahedra instead, E = dV/dx, which contradicts their own S (doc/method.md).

/// What the pores rest on: the parts of the faces.
struct Bases {
  std::vector<int> pore, face;
  std::vector<double> area;  ///< m²
  /// Of a unit pressure on each: force (m²) and moment about the network's origin (m³).
  Matrix6Xd loads;

  int size() const { return static_cast<int>(pore.size()); }
  auto load(int base) const { return loads.col(base); }
};

/// One entry for each of `boundaries.contacts` in their order; those of regions have no area.
Bases measure_bases(const PoreNetwork& network, const PoreBoundaries& boundaries,
                    const Spheres& spheres);

/// In which order a pore's parts of S^T v are added: by the ids of the spheres, so that no byte depends on
/// the order of the packing.
struct SumOrder {
  std::vector<int> rows;  ///< of S by id; empty where they stand so already
  std::vector<int> begin, entry;  ///< the entries of S by pores in that order: what a team needs
};
SumOrder sum_order(const ForceMatrix& forces, const Packing::Ids& ids, int pores, const Team& team);

/// dV/dt = S^T v and what the bases sweep, m³/s, one entry a pore; over all pores they add up to the rate of the box.
/// `order` must have been made for the team; no byte depends on it. Cost: a pass over S.
void reciprocal_rates(const ForceMatrix& forces, const SumOrder& order, const Bases& bases,
                      const Motion& motion, Team& team, Eigen::VectorXd& rates);
/// The magnitude of the terms that the rate of each pore is summed from, m³/s: the rate is exact to its round-off.
Eigen::VectorXd gross_rates(const ForceMatrix& forces, const Bases& bases, const Motion& motion,
                            int pores);

/// E = dV/dx (thesis eqs. 4.4-4.8) in compressed rows, one a pore: the area vectors (m²) that the
/// velocities of spheres and walls are multiplied with.
struct VolumeRateMatrix {
  std::vector<int> row_begin{0};
  std::vector<Vertex> mover;  ///< the sphere, or the wall
  int spheres = 0;
  Eigen::Matrix3Xd area;
  bool stretching = false;  ///< it has the faces of a periodic cell among its movers (physics/cell_stretching.hpp)

  int rows() const { return static_cast<int>(row_begin.size()) - 1; }
};
/// E = dV/dx of the tetrahedra (thesis eqs. 4.4-4.8).
VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres);

/// dV/dt = E v, m³/s, one entry a pore; walls move along their normals.
void volume_rates(const VolumeRateMatrix& matrix, const Motion& motion, Team& team,
                  Eigen::VectorXd& rates);
Eigen::VectorXd gross_rates(const VolumeRateMatrix& matrix, const Motion& motion);

}  // namespace pfv
