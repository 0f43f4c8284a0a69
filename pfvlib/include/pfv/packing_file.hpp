// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/names.hpp"
#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pfv {

class Ranks;

/// The simulation box that a dump or a data file states, m.
struct PackingBounds {
  Eigen::Vector3d lower, upper;
  std::array<bool, 3> periodic{false, false, false};
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< xy, xz, yz of a tilted box (Box::tilt)
  std::array<bool, 3> follows_grains{false, false, false};  ///< a side that shrinks to them (boundary s)

  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
};

/// The smallest box that holds the spheres, without periodic sides. Throws InputError where there is none.
PackingBounds extent_of(const PackingArrays& packing);

/// What a file of spheres holds.
struct PackingFile {
  PackingArrays packing;
  std::optional<PackingBounds> bounds;
  std::optional<std::int64_t> step;  ///< of a dump
  std::vector<std::string> remarks;  ///< what was assumed in reading, a sentence each
};

struct PackingChoice {
  /// Of a dump with several snapshots: "last", a time step, "time=T" where the dump has times, or, where there is no
  /// such time step, the number of the snapshot counted from 1.
  std::string snapshot = "last";
  double length_unit = 1.0;  ///< m; lengths, velocities and bounds of the file are multiples of it
};

/// Metres of "mm", or of a number; throws InputError for what is no unit of length.
double length_unit(const std::string& text);

/// Reads spheres, also packed with gzip, from
/// - a table with a header: separated by commas, semicolons, tabs or blanks, fields may be quoted, lines that begin with #
///   are comments; columns id, x, y, z, radius (or diameter), and vx, vy, vz, omegax, omegay, omegaz, under these or their
///   usual other names; without ids they are numbered from 1;
/// - YADE's text export (`#format x_y_z_r`, or four columns without a header);
/// - a LIGGGHTS or LAMMPS text dump; scaled coordinates are multiplied out, unwrapped ones taken back into a periodic room;
/// - a LIGGGHTS data file (`Atoms` of the styles granular and sphere, `Velocities`);
/// - points of a legacy VTK file (ASCII), a .vtu or a .vtp file.
/// Throws InputError naming file, line and field, or what kind of file it is instead.
///
/// On several ranks each gets an even share of the spheres, those of rank 0 first, and all else that the file holds. Of a
/// table or a dump each rank reads its own part; of the other formats, in which what belongs to a sphere stands in several
/// places, rank 0 reads all. Collective then, and an error is that of all.
PackingFile read_packing_file(const std::string& path, const PackingChoice& choice = {}, const Ranks* ranks = nullptr);

/// The formats that spheres are written in.
enum class PackingFormat {
  table,  ///< id,x,y,z,radius and velocities
  yade,   ///< `#format x_y_z_r`: places and radii alone
  dump,   ///< of LIGGGHTS, with bounds and periodic sides
  data,   ///< of LIGGGHTS, atom style granular, with bounds
  vtu     ///< points for ParaView
};
template <>
struct Names<PackingFormat> {
  static constexpr const char* what = "format";
  static constexpr std::array<Named<PackingFormat>, 5> all{{{PackingFormat::table, "csv"},
                                                            {PackingFormat::yade, "yade"},
                                                            {PackingFormat::dump, "dump"},
                                                            {PackingFormat::data, "data"},
                                                            {PackingFormat::vtu, "vtu"}}};
};

/// How spheres are written.
struct PackingOutput {
  std::optional<PackingFormat> format;  ///< absent: that of the file's ending
  std::optional<double> density;        ///< of the grains, kg/m³, in a data file; absent: 2500, which is remarked
};

/// The format that a file's ending stands for: csv, txt or xyzr (YADE), dump, liggghts or lammpstrj (dump), data, vtu.
/// Throws InputError for another one.
PackingFormat packing_format_of(const std::string& path);

/// Writes spheres so that `read_packing_file` gives the same numbers bit by bit, as far as the format holds them.
/// Returns what it does not hold and what was assumed, a sentence each. The file is whole or absent. Throws InputError
/// for spheres that are none, an ending without a format or a folder that is not there, FileError where it cannot be written.
std::vector<std::string> write_packing_file(const std::string& path, const PackingFile& file,
                                            const PackingOutput& output = {});

}  // namespace pfv
