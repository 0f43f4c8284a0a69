// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"
#include "pfv/report.hpp"

#include <Eigen/Core>
#include <array>
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

/// Of the parts of each boundary: their flow rates and pressures, and how many they are.
struct BoundarySums {
  Eigen::VectorXd inflow, pressure, parts;
  double gross = 0.0;  ///< magnitudes of all flow rates
};
BoundarySums sums_of(const Container& container, const std::vector<BoundaryPart>& parts);

Totals totals_of(const BoundarySums& sums);
/// What crosses each patch and region.
std::vector<OpeningResult> openings_of(const Container& container, const BoundarySums& sums);

/// The net of all fluxes over the largest of them. Where inflow and outflow cancel within each
/// boundary (a wave on one face) their gross sum takes its place, and where all of them are round-off
/// of `could`, what would flow if pressures did not cancel, that does.
double mass_error(const Totals& totals, double volume_rate, double storage_rate,
                  double could = 0.0);

/// The two parallel planes that alone are not sealed, each with one value; else nothing.
std::optional<std::array<int, 2>> faces_of_flow(const Container& container);

/// mu Q L / (dp S), m², with the area of the face that has the higher pressure; nothing where dp is 0.
/// `pressures`: on the two faces, Pa.
std::optional<double> permeability_of(const Container& container, const std::array<int, 2>& faces,
                                      double viscosity, const Totals& totals,
                                      const std::array<double, 2>& pressures);

/// |sum| of the forces on spheres and faces, over the largest pressure times the largest face, or
/// over what a macroscopic gradient drives where that is more.
double force_balance_error(const Eigen::Vector3d& sum, double largest_pressure, const Container& container,
                           double driven);

}  // namespace pfv
