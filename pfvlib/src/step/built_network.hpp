// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"
#include "network/grains.hpp"
#include "network/pore_boundaries.hpp"
#include "physics/conductances.hpp"
#include "physics/force_matrix.hpp"
#include "physics/open_water.hpp"
#include "physics/rigid_bodies.hpp"
#include "physics/shear_forces.hpp"
#include "physics/solid_union.hpp"
#include "physics/throats.hpp"
#include "parallel/share.hpp"
#include "physics/volume_rates.hpp"
#include "solve/closed_pores.hpp"
#include "solve/linear_solver.hpp"
#include "problem/container_geometry.hpp"
#include "solve/pressure_system.hpp"
#include "solve/row_share.hpp"

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pfv {

/// G and its factor.
struct KeptSystem {
  PressureSystem system;
  std::unique_ptr<LinearSolver> solver;         ///< null until the first factorisation
  std::unique_ptr<LinearSolver> former_solver;  ///< of the network before: its memory serves again
  std::optional<Eigen::VectorXd> storage;  ///< V^f / (K_f dt) of each pore, m³/Pa; none for an incompressible fluid
  double storage_dt = 0.0;  ///< time step whose storage term is in the factor
  std::optional<bool> loses_digits;  ///< whether its solves need refinement; unknown before the first

  bool compressible() const { return storage.has_value(); }
};

/// From where to where each cell reaches along an axis, m.
struct CellExtents {
  std::vector<double> low, high;
};

/// What a step or a query makes when it first needs it.
struct KeptOperators {
  std::optional<VolumeRateMatrix> geometric_rates;  ///< E; only where it is wanted
  std::optional<SumOrder> sum_order;                ///< of S^T v
  ViscousShares viscous_shares;                     ///< made with the force matrix
  std::optional<ForceMatrix> force_matrix;          ///< S
  std::optional<ForceMatrix> pressure_force_matrix;
  std::optional<std::pair<Eigen::Vector3d, Loads>> gradient_loads;  ///< for that macroscopic gradient
  std::optional<SurfacePressure> surface_pressure;
  std::optional<std::vector<ShearPair>> shear_pairs;
  std::optional<std::vector<OpenWaterDrag>> open_water;
  bool still_water = true;  ///< that it was made for
  std::optional<RigidBodies> bodies;                ///< as they stood when they were first asked for
  std::optional<SolidUnion> solid;
  std::array<std::optional<CellExtents>, 3> cell_extents;  ///< along each axis
};

/// All that is derived from one packing and kept until the next triangulation.
struct BuiltNetwork {
  std::optional<Halo> halo;    ///< where several ranks share it: the grains that this one knows
  Share share;
  std::shared_ptr<const RowShare> rows;  ///< of its unknowns; null on one rank
  ActiveGrains grains;         ///< with ghosts
  Container container;         ///< as it was then
  ContainerGeometry geometry;  ///< of it, about the network's origin
  PoreNetwork network;
  Spheres vertices;  ///< what the network's vertices stand for: the grains, or those and their images
  PoreBoundaries boundaries;
  Throats throats;
  Conductances conductances;
  Bases bases;  ///< one entry a boundary contact
  Unknowns unknowns;
  ClosedPores closed;
  std::vector<double> strain_volume;  ///< volume that a pore's strain refers to, bounded below
  KeptSystem kept;
  KeptOperators operators;
};

/// Whether there is a pressure to be found, here or on another rank.
inline bool has_unknowns(const BuiltNetwork& built) {
  return built.rows ? built.rows->total > 0 || !built.rows->borders.empty() : built.unknowns.count > 0;
}

/// Of the present network, on all ranks.
std::int64_t pore_count(const BuiltNetwork& built);
std::int64_t merged_pores(const BuiltNetwork& built);
std::int64_t degenerate_throats(const BuiltNetwork& built);
std::int64_t hidden_spheres(const BuiltNetwork& built);

/// Its spheres without ghosts: ids, radii, displaced volumes.
Spheres own_grains(const BuiltNetwork& built);

/// A place (m) for each unknown: that of its pore, or of one of those that share it.
Eigen::Matrix3Xd unknown_places(const BuiltNetwork& built);

CellExtents cell_extents(const PoreNetwork& network, const Spheres& spheres, int axis);

/// Fluid volume of a pore, but at least 1 % of its smallest sphere: about a tenth of what a pore
/// between such spheres holds. Without a bound a nearly empty pore would ask for a new network at
/// every step (thesis eqs. 5.13-5.14 divide by the pore's volume).
std::vector<double> strain_volumes(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres);

/// Fluid volume V^f for the storage of a compressible fluid: the pore's own, but at least 1 % of its
/// whole volume (overlaps can make it negative).
Eigen::VectorXd storage_volumes(const Throats& throats);

}  // namespace pfv
