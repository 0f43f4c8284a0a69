// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>
#include <string>

namespace pfv::python {

/// From now on the library's errors arrive in Python as those of pfv/_errors.py, with the spheres and places
/// that they are about.
void translate_errors();

/// Warns with a class of pfv/_errors.py.
void warn(const char* warning, const std::string& text);

}  // namespace pfv::python
