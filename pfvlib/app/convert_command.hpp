// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <string>

namespace pfv::app {

/// What the command line says, as text.
struct ConvertArguments {
  std::string input, output, format, snapshot = "last", length_unit = "m", density;
  bool at_rest = false;
};

void add_convert_options(CLI::App& command, ConvertArguments& arguments);

/// Reads spheres in one format and writes them in another; what that does not hold, and what was assumed, is said.
void convert(const ConvertArguments& arguments, std::ostream& out, std::ostream& remarks);

}  // namespace pfv::app
