// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>

namespace pfv::app {

/// Writes the table of settings as the page doc/settings.md.
void write_settings(std::ostream& out);

/// Writes the settings of fix pfv in the form of LIGGGHTS' pages, a block of doc/fix_pfv.md.
void write_fix_syntax(std::ostream& out);

/// Writes what each solver is made of and can do, a table of doc/solvers.md.
void write_solver_table(std::ostream& out);

/// Writes boundaries and settings as the Python module's keywords with their types, for its stub: keywords.cmake.
void write_python_keywords(std::ostream& out);

}  // namespace pfv::app
