// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace pfv::python {

/// From now on the library's errors arrive in Python as those of pfv/_errors.py, with the spheres and places
/// that they are about.
void translate_errors();

}  // namespace pfv::python
