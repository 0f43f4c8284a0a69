// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_arguments.hpp"

#include "face_arguments.hpp"
#include "io/atomic_file.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <filesystem>
#include <limits>

namespace pfv::app {
namespace {

namespace fs = std::filesystem;

CLI::Option* repeatable(CLI::Option* option) {
  return option->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

double positive(const std::string& option, const std::string& text) {
  const double value = number(option, text);
  if (value <= 0) throw InputError(option + ": " + text + " is not > 0: give a positive number");
  return value;
}

int whole_number(const std::string& option, const std::string& text) {
  const auto number = detail::integer(text);
  if (!number || *number < 1 || *number > std::numeric_limits<int>::max())
    throw InputError(option + ": " + detail::quoted(text) + " is no whole number >= 1");
  return static_cast<int>(*number);
}

void add_flow_options(CLI::App& command, SolveArguments& arguments) {
  const std::string group = "Flow problem (SI units; a face not named is sealed)";
  command.add_option("--packing", arguments.packing,
                     "spheres (m, m/s): CSV with header id,x,y,z,radius[,vx,vy,vz],\n"
                     "or a LIGGGHTS dump, of which the last snapshot is taken")
      ->required()->option_text("FILE (required)")->group(group);
  command.add_option("--box", arguments.box, "flow box, m")
      ->type_size(6)->expected(1)->required()
      ->option_text("XLO XHI YLO YHI ZLO ZHI (required)")->group(group);
  repeatable(command.add_option("--face", arguments.faces,
                     "condition on a face, may be given several times\n"
                                "NAME  xlo | xhi | ylo | yhi | zlo | zhi\n"
                                "ITEM  pressure=P (Pa) | flux=Q (m3/s, positive into the box) |\n"
                                "      sealed | wall=no_slip|symmetry |\n"
                                "      velocity=V (m/s, positive along +axis)\n"
                                "(default: sealed, at rest)"))
      ->option_text("NAME:ITEM[,ITEM]...")->group(group);
  repeatable(command.add_option("--patch", arguments.patches,
                     "rectangle on a face, may be given several times: its extent (m)\n"
                                "along the two other axes in the order x y z, and one of\n"
                                "pressure=P (Pa) | flux=Q (m3/s) | sealed (default: none)"))
      ->option_text("NAME:A0,A1,B0,B1:ITEM")->group(group);
  repeatable(command.add_option("--region", arguments.regions,
                     "pores inside the packing, for instance a well, may be given several\n"
                                "times: extent (m) and pressure=P (Pa) | flux=Q (m3/s, positive\n"
                                "into the pores) (default: none)"))
      ->option_text("X0,X1,Y0,Y1,Z0,Z1:ITEM")->group(group);
  repeatable(command.add_option("--point", arguments.points,
                     "the pore at a place, as --region (default: none)"))
      ->option_text("X,Y,Z:ITEM")->group(group);
  command.add_option("--periodic", arguments.periodic,
                     "axes along which the packing repeats (default: none)")
      ->delimiter(',')->allow_extra_args(false)->option_text("x,y,z")->group(group);
  command.add_option("--gradient", arguments.gradient,
                     "macroscopic pressure gradient along periodic axes, Pa/m (default 0 0 0)")
      ->type_size(3)->expected(1)->option_text("GX GY GZ")->group(group);
  command.add_option("--wall", arguments.wall,
                     "wall type of every face without wall= of its own (default no_slip)")
      ->option_text("no_slip|symmetry")->group(group);
}

namespace {

double not_negative(const std::string& option, const std::string& text) {
  const double value = number(option, text);
  if (value < 0) throw InputError(option + ": " + text + " is < 0: give 0 or a positive number");
  return value;
}

/// "x", "x,y", "z,x,y": the axes along which the packing repeats.
void apply_periodic(const SolveArguments& arguments, Box& box) {
  for (const std::string& axis : arguments.periodic) {
    if (axis != "x" && axis != "y" && axis != "z")
      throw InputError("--periodic: unknown axis " + detail::quoted(axis) +
                       ": give some of x, y, z, with commas between them");
    bool& periodic = box.periodic[axis[0] - 'x'];
    if (periodic) throw InputError("--periodic: axis " + axis + " occurs twice");
    periodic = true;
  }
  for (std::size_t axis = 0; axis < arguments.gradient.size(); ++axis)
    box.pressure_gradient[static_cast<int>(axis)] = number("--gradient", arguments.gradient[axis]);
}

Box box_of(const SolveArguments& arguments) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = number("--box", arguments.box[2 * axis]);
    box.upper[axis] = number("--box", arguments.box[2 * axis + 1]);
  }
  apply_periodic(arguments, box);
  apply_faces(arguments.faces, wall_named("--wall", arguments.wall), box);
  apply_patches(arguments.patches, box);
  apply_regions(arguments.regions, arguments.points, box);
  check(box);
  return box;
}

Fluid fluid_of(const SolveArguments& arguments) {
  Fluid fluid;
  fluid.viscosity = positive("--viscosity", arguments.viscosity);
  fluid.density = not_negative("--density", arguments.density);
  for (std::size_t axis = 0; axis < arguments.gravity.size(); ++axis)
    fluid.gravity[static_cast<int>(axis)] = number("--gravity", arguments.gravity[axis]);
  if (arguments.bulk_modulus) {
    fluid.bulk_modulus = positive("--bulk-modulus", *arguments.bulk_modulus);
    if (!arguments.time_step)
      throw InputError("--bulk-modulus: a compressible fluid needs a time step: give --time-step");
  }
  check(fluid);
  return fluid;
}

int threads_of(const SolveArguments& arguments) {
  const auto threads = detail::integer(arguments.threads);
  if (!threads || *threads < 1 || *threads > 64)
    throw InputError("--threads: " + detail::quoted(arguments.threads) +
                     " is no number of threads: give 1 to 64");
  return static_cast<int>(*threads);
}

Options options_of(const SolveArguments& arguments) {
  Options options;
  options.partition = named<Partition>(arguments.partition);
  if (arguments.conductance)
    options.conductance = named<ConductanceLaw>(*arguments.conductance);
  else if (options.partition == Partition::yade)
    options.conductance = ConductanceLaw::hydraulic_radius;  // YADE's
  if (arguments.volume_rates)
    options.volume_rates = named<VolumeRates>(*arguments.volume_rates);
  else if (options.partition == Partition::yade)
    options.volume_rates = VolumeRates::geometric;  // YADE's
  options.torques = arguments.torques;
  options.solver = named<SolverKind>(arguments.solver);
  options.ordering = named<OrderingKind>(arguments.ordering);
  options.precision = named<Precision>(arguments.precision);
  if (arguments.tolerance) options.tolerance = number("--tolerance", *arguments.tolerance);
  options.threads = threads_of(arguments);
  // Only what an output shows is computed: the report holds the sum of the forces.
  options.forces = arguments.forces || arguments.report;
  options.split_forces = arguments.forces.has_value();
  check(options);
  return options;
}

/// The grid of --model darcy_grid, or nothing for the pore network.
std::optional<DarcyOptions> grid_of(const SolveArguments& arguments) {
  if (arguments.model == "pfv") {
    if (!arguments.cells.empty() || !arguments.drag.empty())
      throw InputError("--cells and --drag belong to --model darcy_grid: give that too");
    return {};
  }
  if (arguments.model != "darcy_grid")
    throw InputError("--model: unknown model " + detail::quoted(arguments.model) +
                     ": use pfv or darcy_grid");
  if (arguments.cells.empty())
    throw InputError("--model darcy_grid needs the numbers of cells: give --cells NX NY NZ");
  DarcyOptions grid;
  for (std::size_t axis = 0; axis < grid.cells.size(); ++axis)
    grid.cells[axis] = whole_number("--cells", arguments.cells[axis]);
  if (!arguments.drag.empty()) grid.drag = named<DragLaw>(arguments.drag);
  return grid;
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

bool same_file(const std::string& one, const std::string& other) {
  return !detail::is_stream(one) && full_name(one) == full_name(other);  // not /dev/null twice
}

/// One output must neither replace another nor the packing.
void check_outputs(const SolveRequest& request) {
  std::vector<std::string> taken{request.packing};
  for (const auto& output : {request.forces, request.report, request.vtk, request.culprits}) {
    if (!output) continue;
    require_folder_of(*output);
    for (const std::string& other : taken)
      if (same_file(*output, other))
        throw InputError("output " + *output + " would replace " + other +
                         ": give each file a name of its own");
    taken.push_back(*output);
  }
}

void add_fluid_options(CLI::App& command, SolveArguments& arguments) {
  const std::string group = "Fluid";
  command.add_option("--viscosity", arguments.viscosity, "dynamic viscosity, Pa s (default 1e-3)")
      ->option_text("MU")->group(group);
  command.add_option("--density", arguments.density,
                     "density, kg/m3, used with gravity only (default 1000)")
      ->option_text("RHO")->group(group);
  command.add_option("--gravity", arguments.gravity,
                     "gravity, m/s2; adds buoyancy to the forces (default 0 0 0)")
      ->type_size(3)->expected(1)->option_text("GX GY GZ")->group(group);
  command.add_option("--bulk-modulus", arguments.bulk_modulus,
                     "bulk modulus, Pa; needs --time-step (default: incompressible)")
      ->option_text("KF")->group(group);
  command.add_option("--time-step", arguments.time_step,
                     "time step of a compressible fluid, s (default: none)")
      ->option_text("DT")->group(group);
}

void add_method_options(CLI::App& command, SolveArguments& arguments) {
  const std::string group = "Method";
  const Options defaults;
  command.add_option("--model", arguments.model,
                     "pores between the grains, or Darcy flow on a coarse grid (default pfv)")
      ->option_text("pfv|darcy_grid")->group(group);
  command.add_option("--cells", arguments.cells, "cells of darcy_grid along x, y and z")
      ->type_size(3)->expected(1)->option_text("NX NY NZ")->group(group);
  command.add_option("--drag", arguments.drag,
                     std::string("drag on a grain of darcy_grid (default ") +
                         name_of(DarcyOptions{}.drag) + ")")
      ->option_text("di_felice|kozeny_carman")->group(group);
  command.add_option("--conductance", arguments.conductance,
                     "conductance law of a throat (default " +
                         std::string(name_of(defaults.conductance)) +
                         "; with\n--partition yade hydraulic_radius)")
      ->option_text("open_throat|hydraulic_radius|effective_radius")->group(group);
  command.add_option("--partition", arguments.partition,
                     "geometry of a throat: signed volumes, or YADE's rules to reproduce its\n"
                     "results (default " + arguments.partition + ")")
      ->option_text("signed|yade")->group(group);
  command.add_option("--volume-rates", arguments.volume_rates,
                     "how moving grains change the pores' volumes: by the transpose of the forces,\n"
                     "or by the papers' geometry (default reciprocal; with --partition yade geometric)")
      ->option_text("reciprocal|geometric")->group(group);
  command.add_flag("--torques", arguments.torques,
                   "forces act where they lie, and spins (omegax, omegay, omegaz) move fluid")
      ->group(group);
  command.add_option("--solver", arguments.solver,
                     "linear solver (default " + arguments.solver + ": cholmod)")
      ->option_text("auto|cholmod|klu2|mumps|cg|gauss_seidel")->group(group);
  command.add_option("--ordering", arguments.ordering,
                     "fill-reducing ordering (default " + arguments.ordering +
                     ": geometric; for cholmod)")
      ->option_text("auto|geometric|metis|amd")->group(group);
  command.add_option("--tolerance", arguments.tolerance,
                     "residual over right-hand side where cg and gauss_seidel end (default 1e-10)")
      ->option_text("T")->group(group);
  command.add_option("--precision", arguments.precision,
                     "how cholmod keeps its factor: mixed has half as much to read a step and\n"
                     "solves to a residual of 1e-9 (default " + arguments.precision + ")")
      ->option_text("double|mixed")->group(group);
  command.add_option("--threads", arguments.threads,
                     "threads that share a rebuild or step, 1 to 64; they change no result (default " +
                     arguments.threads + ")")
      ->option_text("N")->group(group);
  command.add_option("--repeat", arguments.repeat,
                     "further steps on the kept network, for timing, >= 1 (default: 0)")
      ->option_text("K")->group(group);
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
                     "permeability in m2, velocity in m/s) for ParaView\n"
                     "(default: not written)")
      ->option_text("FILE.vtu")->group(group);
  command.add_option("--culprits", arguments.culprits,
                     "where the packing cannot be solved, the spheres and places that\n"
                     "the error is about (default: not written)")
      ->option_text("FILE.vtu")->group(group);
}

}  // namespace

void add_solve_options(CLI::App& command, SolveArguments& arguments) {
  add_flow_options(command, arguments);
  add_fluid_options(command, arguments);
  add_method_options(command, arguments);
  add_output_options(command, arguments);
  for (CLI::Option* option : command.get_options())
    if (!option->get_option_text().empty()) option->type_name("VALUE");  // in parser's messages
}

SolveRequest request_of(const SolveArguments& arguments) {
  SolveRequest request;
  request.packing = arguments.packing;
  request.box = box_of(arguments);
  request.fluid = fluid_of(arguments);
  request.options = options_of(arguments);
  request.grid = grid_of(arguments);
  if (request.grid) check(*request.grid, request.fluid, request.options);
  if (arguments.time_step) request.time_step = positive("--time-step", *arguments.time_step);
  request.repeat = repeats_of(arguments);
  request.forces = arguments.forces;
  request.report = arguments.report;
  request.vtk = arguments.vtk;
  request.culprits = arguments.culprits;
  check_outputs(request);
  return request;
}

}  // namespace pfv::app
