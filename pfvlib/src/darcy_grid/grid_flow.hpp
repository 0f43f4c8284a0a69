// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "darcy_grid/grid.hpp"
#include "solve/linear_solver.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

// Darcy's law on the grid by finite volumes: k/mu (m²/(Pa s)) is constant in a cell, and a face
// lets through what two half cells in series do (harmonic mean).

/// What a boundary does to each of its cell faces at one instant.
struct GridDrive {
  Eigen::VectorXd imposed;  ///< pressure (Pa), one entry a boundary face; 0 where none is
  Eigen::VectorXd inflow;   ///< m³/s into the box, one entry a boundary face; 0 where none is
};

/// Values of the boundaries at a time (s): a pressure by profile at the middle of the cell face, a
/// flux spread by area. Throws InputError for a flux whose boundary has no cell face. Pressures are
/// relative to `reference`.
GridDrive drive_of(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                   double time, double reference);

/// Mean of the imposed pressures over their faces, Pa; 0 where there is none.
double reference_pressure(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                          double time);

/// True when some face has a pressure, so that the system is definite.
bool has_pressure(const std::vector<GridFace>& faces, const Container& box);

/// The matrix of flow rates that unit pressures in the cells drive out of them, m³/(Pa s).
SymmetricMatrix assemble(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                         const Eigen::VectorXd& mobility);

/// sources (m³/s into each cell) + what the boundaries drive in.
Eigen::VectorXd right_hand_side(const Grid& grid, const std::vector<GridFace>& faces,
                                const Container& box, const Eigen::VectorXd& mobility, const GridDrive& drive,
                                const Eigen::VectorXd& sources);

/// What follows from the pressures of the cells.
struct GridFields {
  Eigen::Matrix3Xd gradient;      ///< Pa/m, one column a cell: Green-Gauss from the face pressures
  Eigen::VectorXd face_pressure;  ///< Pa, one entry a boundary face
  Eigen::VectorXd face_inflow;    ///< m³/s into the box, one entry a boundary face
};

/// The pressure of a face between two cells is the one at which the flow is the same on both sides,
/// so that -mobility gradient is just the mean flow through a cell's opposite faces over their
/// area, and the sum over cells of volume times gradient that of the boundary faces' pressures.
GridFields fields_of(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                     const Eigen::VectorXd& mobility, const GridDrive& drive,
                     const Eigen::VectorXd& pressures);

}  // namespace pfv
