// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve_arguments.hpp"

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace pfv::app {

/// The command line of `pfv time-step` as text.
struct TimeStepArguments {
  SolveArguments problem;
  std::string grain_density, spheres = "all";
  std::vector<std::string> ids, pistons;
  std::optional<std::string> stiffness, tangential, matrices, report;
};

void add_time_step_options(CLI::App& command, TimeStepArguments& arguments);

/// The time steps that an explicit coupling bears in one packing, the true limit and the papers'
/// estimates: a table goes to `out`, all of it into the JSON file, the 3x3 matrices into the CSV file.
/// Throws InputError, FileError, SolverError.
void time_step(const TimeStepArguments& arguments, std::ostream& out, std::ostream& warnings);

}  // namespace pfv::app
