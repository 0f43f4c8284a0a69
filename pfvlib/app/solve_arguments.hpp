// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/darcy_grid.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pfv::app {

/// The command line of `pfv solve` as text. Numbers are read by us and not by the parser, which
/// would take "1abc" and "nan".
struct SolveArguments {
  std::string packing;
  std::vector<std::string> box, faces, patches, regions, points, gravity, periodic, gradient;
  std::string model = "pfv", drag;
  std::vector<std::string> cells;
  std::string wall = "no_slip", viscosity = "1e-3", density = "1000", threads = "1";
  std::string partition = name_of(Options{}.partition), solver = name_of(Options{}.solver),
              ordering = name_of(Options{}.ordering), precision = name_of(Options{}.precision);
  bool torques = false;
  std::optional<std::string> conductance, volume_rates, tolerance, bulk_modulus, time_step, repeat;
  std::optional<std::string> forces, report, vtk, culprits;
};

/// What `pfv solve` is to do.
struct SolveRequest {
  std::string packing;
  Box box;
  Fluid fluid;
  Options options;
  std::optional<DarcyOptions> grid;  ///< absent: the pore network
  double time_step = 0.0;  ///< s; 0: none
  int repeat = 0;          ///< further steps on the kept network
  std::optional<std::string> forces, report, vtk, culprits;  ///< output files
};

/// The whole of `text` as a number > 0, or as a whole number >= 1; throw InputError that names `option`.
double positive(const std::string& option, const std::string& text);
int whole_number(const std::string& option, const std::string& text);

/// Packing, box and what lies around: for every command that solves a flow.
void add_flow_options(CLI::App& command, SolveArguments& arguments);
void add_solve_options(CLI::App& command, SolveArguments& arguments);

/// Throws InputError for whatever can be refused before the packing is read, output folders that
/// are not there included.
SolveRequest request_of(const SolveArguments& arguments);

}  // namespace pfv::app
