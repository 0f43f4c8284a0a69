// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/container.hpp"
#include "pfv/packing_file.hpp"
#include "pfv/settings.hpp"

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pfv::app {

/// The command line of `pfv solve` as text. Numbers are read by us and not by the parser, which
/// would take "1abc" and "nan".
struct SolveArguments {
  std::string packing, snapshot = "last", length_unit = "m";
  bool at_rest = false;
  std::optional<std::string> container, obstacle_diameter;
  std::vector<std::string> box, faces, patches, regions, points, periodic, tilt, gradient, obstacles;
  std::string wall = name_of(Wall::no_slip);
  std::map<std::string, std::vector<std::string>> settings;  ///< by the names of the table
  std::optional<std::string> time_step, repeat;
  std::optional<std::string> forces, report, vtk, culprits;
  /// The packing file, once the box has been looked up in it, and the extent of its spheres, on all ranks.
  std::shared_ptr<PackingFile> file;
  PackingBounds extent;
};

/// What `pfv solve` is to do.
struct SolveRequest {
  std::string packing;
  PackingChoice choice;  ///< of the packing file
  bool at_rest = false;  ///< its velocities are left out
  bool box_of_file = false;  ///< the container is what the packing file says
  std::shared_ptr<PackingFile> file;  ///< if it has been read for that
  Container container;
  Settings settings;
  std::vector<std::string> obstacles;  ///< STL files
  double obstacle_diameter = 0.0;      ///< m; 0: from the grains
  double time_step = 0.0;  ///< s; 0: none
  int repeat = 0;          ///< further steps on the kept network
  std::optional<std::string> forces, report, vtk, culprits;  ///< output files
};

std::string option_of(const Setting& setting);  ///< "--volume-rates"

/// The spheres of the packing file, on several ranks this one's share; remarks on how it was read go to `remarks`. The file
/// that the request has is used up. Collective.
PackingArrays packing_of(const SolveRequest& request, std::ostream& remarks, const Ranks* ranks = nullptr);

/// Packing, box and what lies around: for every command that solves a flow.
void add_flow_options(CLI::App& command, SolveArguments& arguments);
/// The settings of the table that are named, as options of their names.
void add_settings(CLI::App& command, SolveArguments& arguments, const std::vector<std::string>& names);
void add_solve_options(CLI::App& command, SolveArguments& arguments);

/// Throws InputError for whatever can be refused before the packing is read, output folders that
/// are not there included. Collective.
SolveRequest request_of(const SolveArguments& arguments, const Ranks* ranks = nullptr);

/// Metres of "mm" or of a number; throws InputError.
double length_unit_of(const std::string& text);

/// Whether both names lead to one file that a write would replace.
bool same_file(const std::string& one, const std::string& other);

}  // namespace pfv::app
