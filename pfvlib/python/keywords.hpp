// SPDX-License-Identifier: GPL-3.0-or-later
// Settings as keywords: their names, values and defaults are those of the library's table.
#pragma once

#include "pfv/settings.hpp"

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace pfv::python {

namespace py = pybind11;

/// The names of the settings that are keywords: those of a Fluid, or all.
std::vector<std::string> fluid_keywords();
std::vector<std::string> all_keywords();

/// Throws TypeError for a keyword that is not among the names, with the names that are like it.
void require_known(const std::string& function, const std::string& keyword, const std::vector<std::string>& names);

/// Reads keywords into settings. Throws TypeError for unknown ones and for values of another type, InputError
/// for bad values.
void read_keywords(const std::string& function, const py::kwargs& keywords, const std::vector<std::string>& names,
                   Settings& settings);

/// The table, a dict for each row.
py::list table_of_settings();
/// The rows as lines of a docstring.
std::string help_of(const std::vector<std::string>& names);

}  // namespace pfv::python
