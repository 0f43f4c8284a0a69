// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace pfv {

/// The simulation box that a dump or a data file states, m.
struct PackingBounds {
  Eigen::Vector3d lower, upper;
  std::array<bool, 3> periodic{false, false, false};
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< xy, xz, yz of a tilted box (Box::tilt)

  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
};

/// What a file of spheres holds.
struct PackingFile {
  PackingArrays packing;
  std::optional<PackingBounds> bounds;
  std::vector<std::string> remarks;  ///< what was assumed in reading, a sentence each
};

struct PackingChoice {
  /// Of a dump with several snapshots: "last", a time step, "time=T" where the dump has times, or, where there is no
  /// such time step, the number of the snapshot counted from 1.
  std::string snapshot = "last";
  double length_unit = 1.0;  ///< m; lengths, velocities and bounds of the file are multiples of it
};

/// Reads spheres, also packed with gzip, from
/// - a table with a header: separated by commas, semicolons, tabs or blanks, fields may be quoted, lines that begin with #
///   are comments; columns id, x, y, z, radius (or diameter), and vx, vy, vz, omegax, omegay, omegaz, under these or their
///   usual other names; without ids they are numbered from 1;
/// - YADE's text export (`#format x_y_z_r`, or four columns without a header);
/// - a LIGGGHTS or LAMMPS text dump; scaled coordinates are multiplied out, unwrapped ones taken back into a periodic room;
/// - a LIGGGHTS data file (`Atoms` of the styles granular and sphere, `Velocities`);
/// - points of a legacy VTK file (ASCII), a .vtu or a .vtp file.
/// Throws InputError naming file, line and field, or what kind of file it is instead.
PackingFile read_packing_file(const std::string& path, const PackingChoice& choice = {});

}  // namespace pfv
