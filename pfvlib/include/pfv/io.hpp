// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"
#include "pfv/fields.hpp"
#include "pfv/flow_model.hpp"
#include "pfv/packing.hpp"
#include "pfv/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace pfv {

/// The spheres of a file in any format that `read_packing_file` takes; of a dump, the last snapshot. What was assumed
/// in reading, `read_packing_file` says, too. Throws InputError naming file, line and field.
PackingArrays read_packing(const std::string& path);

/// Reads a container: JSON {"planes": [{"name", "inward_normal": [x, y, z], "offset"}, ...], "cylinders": [{"name",
/// "axis": [x, y, z], "point": [x, y, z], "radius"}, ...]}, m; inside: inward_normal . x >= offset, and within each
/// cylinder. The inward normal need not be a unit vector; the offset scales with it. A cylinder with "flats": N is N planes
/// around of its section, named shell_1 ... shell_N where it is named shell. Throws InputError naming file and entry.
Container read_container(const std::string& path);
/// The same from text; `where` stands for the file in errors.
Container container_of_json(const std::string& text, const std::string& where);

// Every writer writes beside the target and renames at the end: a file is whole or absent.
// Each throws FileError.

/// Text of a caller's own. A stream (a device, a pipe, /dev/stdout) is appended to.
void write_text(const std::string& path, const std::string& text);

/// `id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz`, N; needs split forces. On several ranks each has some of the rows, those of
/// rank 0 first; that one writes them, rank by rank. Collective then.
void write_forces(const std::string& path, const Packing& packing, const Forces& forces, const Ranks* ranks = nullptr);

/// The report as JSON, keys as in `Report`; absent values are null.
std::string json_of(const Report& report);
/// The same as a file.
void write_report(const std::string& path, const Report& report);

/// The report as a few lines of text: phases with their times and counts, sizes, balances, which code solved.
std::string summary_of(const Report& report);
/// The papers to cite for the pore network.
const char* citation();

/// Spheres as points of a .vtu: id, radius, velocity, force, mean pressure around each and `more`, one column a sphere
/// of the packing; a field without columns is not written.
void write_spheres(const std::string& path, const Packing& packing, const Forces& forces,
                   const std::vector<Field>& more = {});
/// The same to be written.
FieldGrid grid_of_spheres(const Packing& packing, const Forces& forces, const std::vector<Field>& more = {});

/// The walls of a container as polygons to be drawn: a plane's part of it, a cylinder as flat strips and its ends as their
/// polygons; none along periodic axes. Of each cell the face's `name`, kind of `wall` ("open" where fluid crosses) and
/// `boundary`, its number `face`, `velocity` in its middle (m/s) and, of the whole face, `area` (m²), and of its result, where
/// there is one, `flux` (m³/s, into the container), `force`, `force_pressure` and `force_viscous` (N).
FieldGrid grid_of_walls(const Container& container, const std::vector<FaceResult>& results = {});

/// FILE_walls.vtu for FILE.vtu or FILE.pvtu; absent for any other name (a device, a pipe).
std::optional<std::string> walls_beside(const std::string& path);
/// Writes `grid_of_walls` beside the fields of the pores, where they have such a name. Of a cell without walls an older file
/// is removed, which would be taken for that of these fields.
void write_walls_beside(const std::string& path, const Container& container, const std::vector<FaceResult>& results = {});

/// The spheres and places that an error is about as points of a .vtu: id (-1 for a place) and radius (0).
void write_culprits(const std::string& path, const Packing& packing, const Culprits& culprits);

/// One time step of a .pvd collection; `file` is relative to the collection's folder.
struct CollectionEntry {
  double time;  ///< s
  int part;     ///< 0 pores, 1 grains, 2 walls
  std::string file;
};
void write_collection(const std::string& path, const std::vector<CollectionEntry>& entries);

/// Throws InputError unless the folder that is to hold `path` exists and is writable: called before
/// any work is done.
void require_folder_of(const std::string& path);

}  // namespace pfv
