// SPDX-License-Identifier: GPL-3.0-or-later
// Where the walls of a script stand beside each other and beside the grains.
#ifndef LMP_PFV_WALL_PLACES_H
#define LMP_PFV_WALL_PLACES_H

#include "arguments.h"

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

/// Directions, places and volumes of walls that differ by less are the same: STL files carry some seven digits.
inline constexpr double same = 1e-6;

/// Whether two are one plane, whichever way they look. `nothing`: a length that is round-off.
bool same_plane(const pfv::Surface& a, const pfv::Surface& b, double nothing);

/// The plane with a place on its inner side.
pfv::Surface facing(const pfv::Surface& surface, const Eigen::Vector3d& inside);

/// Whether a face's plane lies behind that of another face. Grains end before all walls, also those still to come.
bool is_behind_another(std::size_t face, const pfv::Surface& plane, const PfvSettings& settings,
                       const std::vector<std::vector<pfv::Surface>>& surfaces, const Eigen::Vector3d& middle);

/// Takes a face out, with its source and its surfaces.
void remove_wall(PfvSettings& settings, std::vector<std::vector<pfv::Surface>>& surfaces, std::size_t face);

/// Of the container with these walls, each with the grains' middle on its inner side; nothing if it is open.
std::optional<double> volume_within(const std::vector<std::vector<pfv::Surface>>& of_faces, const Eigen::Vector3d& middle);

}  // namespace LAMMPS_NS

#endif
