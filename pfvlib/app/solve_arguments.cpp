// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_arguments.hpp"

#include "box_arguments.hpp"
#include "face_arguments.hpp"
#include "io/atomic_file.hpp"
#include "numbers.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"
#include "parallel/one_rank.hpp"
#include "pfv/packing_file.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>
#include <utility>

namespace pfv::app {
namespace {

namespace fs = std::filesystem;

CLI::Option* repeatable(CLI::Option* option) {
  return option->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

std::string option_of(const Setting& setting) {
  std::string option = setting.name;
  std::replace(option.begin(), option.end(), '_', '-');
  return "--" + option;
}

namespace {

void add_packing_options(CLI::App& command, SolveArguments& arguments, const std::string& group) {
  command.add_option("--packing", arguments.packing,
                     "spheres (m, m/s): a table with header id,x,y,z,radius[,vx,vy,vz],\n"
                     "a LIGGGHTS dump or data file, points of a .vtk, .vtu or .vtp file;\n"
                     "also packed with gzip")
      ->required()->option_text("FILE (required)")->group(group);
  command.add_option("--snapshot", arguments.snapshot,
                     "of a dump: its time step, time=T where it has times, or where there\n"
                     "is no such step its number, from 1 (default last)")
      ->option_text("N|time=T|last")->group(group);
  command.add_option("--length-unit", arguments.length_unit,
                     "unit of the packing file's lengths, its velocities a second: a name\n"
                     "or a number of metres (default m)")
      ->option_text("m|cm|mm|um|METRES")->group(group);
  command.add_flag("--at-rest", arguments.at_rest, "leave the velocities of the file out (default: taken)")->group(group);
  command.add_option("--box", arguments.box,
                     "flow box, m; `dump`: the simulation box that the file states;\n"
                     "`auto`: the extent of the spheres (required, or --container;\n"
                     "without both, a dump that is periodic all around gives its own)")
      ->expected(1, 6)->option_text("XLO XHI YLO YHI ZLO ZHI|dump|auto")->group(group);
  command.add_option("--container", arguments.container,
                     "planes at any angle, or a cylinder between two (doc/container.md):\n"
                     "{\"planes\": [{\"name\", \"inward_normal\": [x,y,z], \"offset\"}, ...],\n"
                     " \"cylinders\": [{\"name\", \"axis\", \"point\", \"radius\"}]}\n"
                     "(default: none)")
      ->option_text("FILE.json")->group(group);
}

/// "sealed | pressure=P (Pa, of each pore on it) | ...", a line for each; of a region those that are open.
std::string boundary_help(const char* between, bool of_region = false) {
  return list_boundary_kinds([&](const BoundaryKind& one) {
    if (of_region && !one.is_open()) return std::string();
    return one.symbol ? std::string(one.name) + "=" + one.symbol + " (" + one.unit + ", " + one.note + ")" : one.name;
  }, between);
}

void add_face_options(CLI::App& command, SolveArguments& arguments, const std::string& group) {
  repeatable(command.add_option("--face", arguments.faces,
                     "condition on a face, may be given several times\n"
                                "NAME  xlo | xhi | ylo | yhi | zlo | zhi, or of the container\n"
                                "ITEM  " + boundary_help(" |\n      ") + " |\n"
                                "      wall=" + names_of<Wall>("|") + " |\n"
                                "      velocity=V (m/s, positive along +axis; along its inward\n"
                                "      normal in a container) | spin=W (rad/s, a cylinder)\n"
                                "(default: sealed, at rest)"))
      ->option_text("NAME:ITEM[,ITEM]...")->group(group);
  repeatable(command.add_option("--patch", arguments.patches,
                     "part of a face, may be given several times: the extent (m) of a\n"
                                "rectangle along the two other axes in the order x y z, or of a\n"
                                "block of space that cuts it out of any face, and one of\n" +
                                boundary_help(" |\n") + " (default: none)"))
      ->option_text("NAME:A0,A1,B0,B1:ITEM or NAME:X0,X1,Y0,Y1,Z0,Z1:ITEM")->group(group);
  repeatable(command.add_option("--region", arguments.regions,
                     "pores inside the packing, for instance a well, may be given several\n"
                                "times: extent (m) and one of\n" + boundary_help(" |\n", true) + "\n(default: none)"))
      ->option_text("X0,X1,Y0,Y1,Z0,Z1:ITEM")->group(group);
  repeatable(command.add_option("--point", arguments.points,
                     "the pore at a place, as --region (default: none)"))
      ->option_text("X,Y,Z:ITEM")->group(group);
  command.add_option("--wall", arguments.wall,
                     "wall type of every face without wall= of its own (default no_slip)")
      ->option_text(names_of<Wall>("|"))->group(group);
}

void add_cell_options(CLI::App& command, SolveArguments& arguments, const std::string& group) {
  command.add_option("--periodic", arguments.periodic,
                     "axes along which the packing repeats, or `dump`: those of the\n"
                     "dump's simulation box, with their bounds (--box is needed where\n"
                     "an axis is not periodic); of a container those between two planes\n"
                     "that nothing else crosses (default: none)")
      ->delimiter(',')->allow_extra_args(false)->option_text("x,y,z|dump")->group(group);
  command.add_option("--tilt", arguments.tilt,
                     "how far a tilted periodic cell leans, m: xy, the way of its upper y\n"
                     "side along x, and so on (default 0 0 0)")
      ->type_size(3)->expected(1)->option_text("XY XZ YZ")->group(group);
  command.add_option("--gradient", arguments.gradient,
                     "macroscopic pressure gradient along periodic axes, Pa/m (default 0 0 0)")
      ->type_size(3)->expected(1)->option_text("GX GY GZ")->group(group);
}

}  // namespace

void add_flow_options(CLI::App& command, SolveArguments& arguments) {
  const std::string group = "Flow problem (SI units; a face not named is sealed)";
  add_packing_options(command, arguments, group);
  add_face_options(command, arguments, group);
  add_cell_options(command, arguments, group);
}

double length_unit_of(const std::string& text) {
  try {
    return length_unit(text);
  } catch (const InputError& error) {
    throw InputError(std::string("--length-unit: ") + error.what());
  }
}

namespace {

Container container_of(const SolveArguments& arguments) {
  const bool has_box = !arguments.box.empty() || periodic_as_dump(arguments);
  if (arguments.container && has_box)
    throw InputError("--box and --container exclude each other: give one of them");
  if (!arguments.container && !has_box) refuse_without_box(arguments);
  if (arguments.container && !arguments.tilt.empty()) throw InputError("--tilt needs a --box");
  Container container = arguments.container ? read_container(*arguments.container) : Container(box_of(arguments));
  if (arguments.container) {
    container.periodic = periodic_axes(arguments);
    container.pressure_gradient = gradient_of(arguments);
  }
  apply_faces(arguments.faces, wall_named("--wall", arguments.wall), container);
  apply_patches(arguments.patches, container);
  apply_regions(arguments.regions, arguments.points, container);
  check(container);
  return container;
}

/// Only what an output shows is computed: the report holds the sum of the forces.
Settings settings_of(const SolveArguments& arguments) {
  Settings settings;
  for (const Setting& setting : all_settings()) {
    const auto given = arguments.settings.find(setting.name);
    if (given == arguments.settings.end() || given->second.empty()) continue;
    Words words(given->second, option_of(setting));
    read(setting, words, settings);
  }
  settings.options.forces = arguments.forces || arguments.report;
  settings.options.split_forces = arguments.forces.has_value();
  if (settings.fluid.bulk_modulus && !arguments.time_step)
    throw InputError("--bulk-modulus: a compressible fluid needs a time step: give --time-step");
  settle(settings);
  check(settings);
  return settings;
}

int repeats_of(const SolveArguments& arguments) {
  if (!arguments.repeat) return 0;
  return whole_number("--repeat", *arguments.repeat);
}

/// The one name that a file has, there or not yet.
fs::path full_name(const std::string& path) {
  std::error_code none;
  return fs::weakly_canonical(fs::absolute(path, none), none);
}

}  // namespace

bool same_file(const std::string& one, const std::string& other) {
  return !detail::is_stream(one) && full_name(one) == full_name(other);  // not /dev/null twice
}

namespace {

/// One output must neither replace another nor the packing.
void check_outputs(const SolveRequest& request) {
  const std::string ending = request.vtk ? std::filesystem::path(*request.vtk).extension().string() : "";
  if (!ending.empty() && ending != ".vtu" && ending != ".pvtu")
    throw InputError("--vtk " + *request.vtk + ": ParaView knows this form by the ending .vtu: give a file .vtu (pictures "
                     "of it: python3 -m pfv.render)");
  std::vector<std::string> taken{request.packing};
  const auto walls = request.vtk ? walls_beside(*request.vtk) : std::nullopt;
  for (const auto& output : {request.forces, request.report, request.vtk, request.culprits, walls}) {
    if (!output) continue;
    require_folder_of(*output);
    for (const std::string& other : taken)
      if (same_file(*output, other))
        throw InputError("output " + *output + " would replace " + other +
                         ": give each file a name of its own");
    taken.push_back(*output);
  }
}

void add_time_step_option(CLI::App& command, SolveArguments& arguments) {
  command.add_option("--time-step", arguments.time_step, "time step of a compressible fluid, s (default: none)")
      ->option_text("DT")->group("Fluid");
}

void add_output_options(CLI::App& command, SolveArguments& arguments) {
  const std::string group = "Output (without any: a summary on standard output)";
  command.add_option("--forces", arguments.forces,
                     "force on each sphere (N): id, fx,fy,fz (total), fpx,fpy,fpz\n"
                     "(pressure part with buoyancy), fvx,fvy,fvz (viscous part)\n"
                     "(default: not written)")
      ->option_text("FILE.csv")->group(group);
  command.add_option("--report", arguments.report,
                     "what was done and how well it balances (default: not written)")
      ->option_text("FILE.json")->group(group);
  command.add_option("--vtk", arguments.vtk,
                     "pores (pressure in Pa, fluid volume in m3) and throats\n"
                     "(conductance in m3/(Pa s), flux in m3/s), or cells (porosity,\n"
                     "permeability in m2, velocity in m/s) for ParaView;\n"
                     "the walls and their loads go to FILE_walls.vtu\n"
                     "(default: not written); on several ranks FILE.pvtu and a\n"
                     "piece a rank")
      ->option_text("FILE.vtu")->group(group);
  repeatable(command.add_option("--obstacle", arguments.obstacles,
                                "a body among the grains, at rest: its surface as an STL file (m), text or binary"));
  command.add_option("--obstacle-diameter", arguments.obstacle_diameter,
                     "of the smallest spheres in its place, m (default: half the grains' mean diameter)");
  command.add_option("--culprits", arguments.culprits,
                     "where the packing cannot be solved, the spheres and places that\n"
                     "the error is about (default: not written)")
      ->option_text("FILE.vtu")->group(group);
}

/// Lines of the parser's help, whose column is narrow.
std::string wrapped(const std::string& text) {
  constexpr std::size_t width = 75;
  std::string lines;
  std::size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word; column += word.size() + 1) {
    if (column > 0) lines += column + word.size() > width ? '\n' : ' ';
    if (column + word.size() > width) column = 0;
    lines += word;
  }
  return lines;
}

std::string help_of(const Setting& setting) {
  const std::string unit = setting.unit;
  return wrapped(setting.help + setting.lacks + (unit.empty() ? "" : ", " + unit) + " (default " +
                 setting.text(Settings{}) + ")");
}

}  // namespace

void add_settings(CLI::App& command, SolveArguments& arguments, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const Setting& setting = *setting_named(name);
    std::vector<std::string>& words = arguments.settings[name];
    if (setting.words == 0)  // without a word yes, as a flag
      command.add_option(option_of(setting), words, help_of(setting))
          ->expected(0, 1)->default_str("yes")->option_text('[' + setting.values + ']')->group(setting.group);
    else
      command.add_option(option_of(setting), words, help_of(setting))
          ->type_size(setting.words)->expected(1)->option_text(setting.values)->group(setting.group);
  }
}

void add_solve_options(CLI::App& command, SolveArguments& arguments) {
  add_flow_options(command, arguments);
  std::vector<std::string> names;
  for (const Setting& setting : all_settings())
    if (setting.hosts.command) names.push_back(setting.name);
  add_settings(command, arguments, names);
  add_time_step_option(command, arguments);
  command.add_option("--repeat", arguments.repeat,
                     "further steps on the kept network, for timing, >= 1 (default: 0)")
      ->option_text("K")->group("Solver");
  add_output_options(command, arguments);
  for (CLI::Option* option : command.get_options())
    if (!option->get_option_text().empty()) option->type_name("VALUE");  // in parser's messages
}

namespace {

void check_obstacles(const SolveRequest& request) {
  if (request.obstacles.empty() && request.obstacle_diameter > 0.0)
    throw InputError("--obstacle-diameter: there is no --obstacle FILE.stl that it is for");
  if (!request.obstacles.empty() && request.container.any_periodic())
    throw InputError("--obstacle takes no periodic box; give it walls");
  if (!request.obstacles.empty() && request.settings.grid())
    throw InputError("--obstacle: the model darcy_grid knows none; take the model pfv");
}

}  // namespace

namespace {

/// Once the box has been looked for.
SolveRequest request_in_box(const SolveArguments& arguments) {
  SolveRequest request;
  request.box_of_file = box_of_file(arguments);
  request.packing = arguments.packing;
  request.choice = {arguments.snapshot, length_unit_of(arguments.length_unit)};
  request.at_rest = arguments.at_rest;
  request.file = arguments.file;
  request.container = container_of(arguments);
  request.settings = settings_of(arguments);
  if (arguments.time_step) request.time_step = positive("--time-step", *arguments.time_step);
  request.obstacles = arguments.obstacles;
  if (arguments.obstacle_diameter)
    request.obstacle_diameter = positive("--obstacle-diameter", *arguments.obstacle_diameter);
  check_obstacles(request);
  request.repeat = repeats_of(arguments);
  request.forces = arguments.forces;
  request.report = arguments.report;
  request.vtk = arguments.vtk;
  request.culprits = arguments.culprits;
  check_outputs(request);
  return request;
}

}  // namespace

SolveRequest request_of(const SolveArguments& given, const Ranks* ranks) {
  SolveArguments arguments = given;
  look_for_box(arguments, ranks_or_one(ranks));
  SolveRequest request;
  ranks_or_one(ranks).together([&] { request = request_in_box(arguments); });
  return request;
}

namespace {

/// A packing that goes on beyond its borders, in a box of walls, has other pores there.
void warn_of_periodic_dump(const SolveRequest& request, const std::optional<PackingBounds>& bounds,
                           std::ostream& remarks) {
  if (request.container.any_periodic() || !bounds || !bounds->any_periodic()) return;
  remarks << "pfv: warning: the simulation box of this dump is periodic along";
  for (int axis = 0; axis < 3; ++axis)
    if (bounds->periodic[axis]) remarks << ' ' << "xyz"[axis];
  remarks << ", and walls stand there now: --periodic dump takes its cell\n";
}

/// Another cell than the dump's makes other pores at its sides. Dumps have six digits.
void refuse_another_cell(const SolveRequest& request, const std::optional<PackingBounds>& bounds) {
  const Container& given = request.container;
  if (!bounds || !given.is_box) return;
  const auto compare = [&](int axis, int other, const char* what, double of_dump, double of_box) {
    for (const int one : {axis, other})
      if (!given.periodic[one] || !bounds->periodic[one]) return;
    const double size = std::max({std::abs(bounds->lower[axis]), std::abs(bounds->upper[axis]), std::abs(of_dump)});
    if (std::abs(of_dump - of_box) <= 1e-5 * size) return;
    std::ostringstream text;
    text << request.packing << ": " << what << " of its periodic cell is " << of_dump << " m, that of the box "
         << of_box << " m: give --periodic dump, which takes the cell from the dump";
    throw InputError(text.str());
  };
  constexpr const char* lengths[]{"the length along x", "the length along y", "the length along z"};
  const Eigen::Vector3d of_dump = bounds->upper - bounds->lower, of_box = given.upper - given.lower;
  for (int axis = 0; axis < 3; ++axis) compare(axis, axis, lengths[axis], of_dump[axis], of_box[axis]);
  compare(0, 1, "the tilt xy", bounds->tilt[0], given.tilt[0]);
  compare(0, 2, "the tilt xz", bounds->tilt[1], given.tilt[1]);
  compare(1, 2, "the tilt yz", bounds->tilt[2], given.tilt[2]);
}

}  // namespace

PackingArrays packing_of(const SolveRequest& request, std::ostream& remarks, const Ranks* ranks) {
  PackingFile file = request.file ? std::move(*request.file) : read_packing_file(request.packing, request.choice, ranks);
  for (const std::string& remark : file.remarks) remarks << "pfv: " << request.packing << ": " << remark << '\n';
  warn_of_periodic_dump(request, file.bounds, remarks);
  ranks_or_one(ranks).together([&] { refuse_another_cell(request, file.bounds); });
  if (request.box_of_file && request.container.is_box) {
    remarks << "pfv: " << request.packing << ": the flow box was taken from it:" << std::setprecision(12);
    for (int axis = 0; axis < 3; ++axis)
      remarks << ' ' << request.container.lower[axis] << ' ' << request.container.upper[axis];
    remarks << (request.container.any_periodic() ? ", periodic\n" : "\n") << std::setprecision(6);
  }
  if (request.at_rest) file.packing.velocities.resize(3, 0);
  if (request.at_rest) file.packing.angular_velocities.resize(3, 0);
  return std::move(file.packing);
}

}  // namespace pfv::app
