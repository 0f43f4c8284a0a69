// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/report.hpp"
#include "solve/linear_solver.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace pfv {

// What the reports of all flow models have in common; doc/conventions.md has the definitions.

/// Fluxes of the faces and patches, m³/s, all >= 0; gross: without netting within one of them.
struct Totals {
  double inflow = 0.0, outflow = 0.0, gross = 0.0;
};

/// A piece of a boundary: a pore's part of it, or a face of a cell.
struct BoundaryPart {
  int boundary;     ///< its number, see boundary_of
  double inflow;    ///< m³/s into the box
  double pressure;  ///< Pa
};

Totals totals_of(const Box& box, const std::vector<BoundaryPart>& parts);
/// What crosses each patch and region.
std::vector<OpeningResult> openings_of(const Box& box, const std::vector<BoundaryPart>& parts);

/// The net of all fluxes over the largest of them. Where inflow and outflow cancel within each
/// boundary (a wave on one face) their gross sum takes its place, and where all of them are round-off
/// of `could`, what would flow if pressures did not cancel, that does.
double mass_error(const Totals& totals, double volume_rate, double storage_rate,
                  double could = 0.0);

/// The axis of the two opposite faces that alone are not sealed, each with one value; else nothing.
std::optional<int> axis_of_flow(const Box& box);

/// mu Q L / (dp S), m²; nothing where dp is 0.
std::optional<double> permeability_of(const Box& box, int axis, double viscosity,
                                      const Totals& totals, double difference);

/// |sum| of the forces on spheres and faces, over the largest pressure times the largest face, or
/// over what a macroscopic gradient drives where that is more.
double force_balance_error(const Eigen::Vector3d& sum, double largest_pressure, const Box& box,
                           double driven);

/// |b - A x| / |b|; 0 where there is nothing to solve.
double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b);

/// Bytes that the process has held at most.
std::int64_t peak_memory();

}  // namespace pfv
