// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "darcy_grid/solid_overlaps.hpp"
#include "pfv/darcy_grid.hpp"

#include <Eigen/Core>

namespace pfv {

/// The cells as the grains in them feel them, one entry (or column) a cell.
struct CellState {
  Eigen::VectorXd porosity, permeability;  ///< -, m²
  Eigen::Matrix3Xd gradient;               ///< Pa/m
  Eigen::Matrix3Xd discharge;  ///< m/s, of the fluid over the total area, against the grains
  Eigen::Matrix3Xd carried;    ///< m/s, of the grains that carry the fluid along, or 0
};

/// The velocity of the grains in each cell, weighted by their volume there, m/s; 0 where there is
/// none.
Eigen::Matrix3Xd grain_velocities(const SolidOverlaps& overlaps,
                                  const Eigen::Matrix3Xd& velocities);

/// Volume that moving grains push out of each cell, m³/s: across a face between cells goes the mean
/// of the grains in both, by volume, at a face of the box its own velocity. Adds up to the rate of
/// the box.
Eigen::VectorXd volume_rates(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                             const SolidOverlaps& overlaps,
                             const Eigen::Matrix3Xd& cell_velocities);

/// Drag per volume of grain and per velocity, Pa s/m², for a velocity U (m/s) over the total area.
/// Di Felice 1994 with the drag coefficient of Dallavalle: the force on a sphere of radius r is
/// 1/2 C_d rho pi r² U² e^-chi, C_d = (0.63 + 4.8/sqrt(Re))², Re = 2 rho r U/mu,
/// chi = 3.7 - 0.65 exp(-(1.5 - log10 Re)²/2).
double di_felice_drag(const Fluid& fluid, double radius, double porosity, double speed);
/// What Darcy's law resists, shared among the grains: mu e/(K (1 - e)), the solid fraction 1 - e at
/// least that at which the permeability is capped. Adds up to e times the pressure gradient.
double kozeny_carman_drag(const Fluid& fluid, double permeability, double porosity);

struct GrainForces {
  Eigen::Matrix3Xd pressure;  ///< N, one column a sphere: -(its part of each cell) grad p
  Eigen::Matrix3Xd drag;      ///< N
};

/// The drag's coefficient (Pa s/m²) of each part of `overlaps` at the present velocities.
Eigen::VectorXd drag_coefficients(const SolidOverlaps& overlaps, const Spheres& spheres,
                                  const Fluid& fluid, DragLaw law, const CellState& cells,
                                  const Eigen::Matrix3Xd& velocities);

/// Forces with the coefficients given: linear in gradient, discharge and velocities.
GrainForces grain_forces(const SolidOverlaps& overlaps, const Eigen::VectorXd& coefficients,
                         const CellState& cells, const Eigen::Matrix3Xd& velocities);

}  // namespace pfv
