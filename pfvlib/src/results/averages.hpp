// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow.hpp"
#include "results/balance.hpp"

namespace pfv {

// Velocities, fluxes and stresses of a solution: see Flow. `packed`: spheres in the packing.

/// Throws InputError unless axis is 0, 1 or 2.
void require_axis(int axis);
Eigen::Matrix3Xd pore_velocities(const BuiltNetwork& built, const Balance& balance);
Eigen::Matrix3Xd sphere_velocities(const BuiltNetwork& built, const Balance& balance,
                                   Eigen::Index packed);
Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_stresses(const BuiltNetwork& built,
                                                         const Solution& solution,
                                                         Eigen::Index packed);
double plane_flux(const BuiltNetwork& built, const Solution& solution, const Balance& balance,
                  int axis, double position);
SliceMeans slice_means(const BuiltNetwork& built, const Solution& solution, const Balance& balance,
                       int axis, double lower, double upper);

/// See Flow::empty_space.
EmptySpace empty_space(const BuiltNetwork& built);
/// Of the pore whose tetrahedron contains the place. Throws InputError outside the box.
double pressure_at(const BuiltNetwork& built, const Solution& solution,
                   const Eigen::Vector3d& place);
/// Mean over the pores that the plane cuts. Throws InputError where there is none.
double plane_pressure(BuiltNetwork& built, const Solution& solution, int axis, double position);
/// Weighted with the pores' volume.
double mean_pressure(const BuiltNetwork& built, const Solution& solution);

}  // namespace pfv
