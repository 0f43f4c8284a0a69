// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/built_network.hpp"
#include "step/problem.hpp"
#include "work/work_record.hpp"

#include <cstdint>

namespace pfv {

// The operators of a network, made when they are first needed, and what they give.

/// S, where it is not there yet.
void make_force_matrix(BuiltNetwork& built, const Problem& problem, Counts& counts);
/// What volume rates need, likewise: S, or E where the options want that.
void make_volume_rates(BuiltNetwork& built, const Problem& problem, Counts& counts);
/// S and what the options want of the forces beside.
void make_force_matrices(BuiltNetwork& built, const Problem& problem, Counts& counts);

/// Spheres that are braked as in open water, on all ranks.
std::int64_t open_water_count(const BuiltNetwork& built);

/// S p with the pressures on the faces, N and N m.
Loads loads_of(const BuiltNetwork& built, const Eigen::VectorXd& pressures);
/// Those of faces are summed over all ranks; ghosts have theirs from their owners.
void join_loads(const BuiltNetwork& built, Loads& loads);
/// What a macroscopic gradient adds to it; kept for that gradient.
const Loads& gradient_loads(BuiltNetwork& built, const Problem& problem);
/// Shear forces of this motion; none where switched off.
Loads shear_forces_of(const BuiltNetwork& built, double viscosity, const Motion& motion);
/// Adds what brakes spheres in open water, and its reactions on what stands around.
void add_open_water_forces(const BuiltNetwork& built, const Motion& motion, Loads& loads);
/// What resists this motion beside the pressures, both of these: -R v, N.
Loads resisting_forces(const BuiltNetwork& built, double viscosity, const Motion& motion);
/// R of the spheres.
std::vector<ResistanceBlock> resistance_blocks(const BuiltNetwork& built, double viscosity);

/// What a macroscopic gradient (Pa/m) drives into each pore, m³/s.
Eigen::VectorXd gradient_sources(const BuiltNetwork& built, const Eigen::Vector3d& gradient);

/// dV/dt of each pore, m³/s, from the network as it was built.
void rates_of(const BuiltNetwork& built, const Motion& motion, Team& team, Eigen::VectorXd& rates);
/// What they are summed from, m³/s; zeros where none have been asked for.
Eigen::VectorXd gross_rates(const BuiltNetwork& built, const Motion& motion);

/// Pressures (Pa) that sources (m³/s, one entry a pore) cause on the kept factor where every imposed
/// pressure is 0. `solves`: where the solve is counted.
Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, const Eigen::VectorXd& sources,
                                      std::int64_t& solves);
/// The same by another solver for the same unknowns.
Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, LinearSolver& solver,
                                      const Eigen::VectorXd& sources, std::int64_t& solves);

}  // namespace pfv
