// SPDX-License-Identifier: GPL-3.0-or-later
// What the module consists of, a file each.
#pragma once

#include "pfv/box.hpp"
#include "pfv/container.hpp"

#include <pybind11/pybind11.h>
#include <string>

namespace pfv::python {

namespace py = pybind11;

void add_box_class(py::module_& module);
void add_container_class(py::module_& module);
void add_fluid_class(py::module_& module);
void add_packing_class(py::module_& module);
void add_network_class(py::module_& module);
void add_rigid_body_class(py::module_& module);
void add_flow_class(py::module_& module);
void add_permeability(py::module_& module);
void add_grain_stresses(py::module_& module);

/// [[xlo, xhi], [ylo, yhi], [zlo, zhi]], all faces sealed. Throws InputError.
Box make_box(py::handle bounds, const std::string& wall, py::handle periodic);
/// Of a Container, a Box, or the bounds of one whose faces are sealed and no-slip. Throws InputError.
Container container_of(py::handle given);

}  // namespace pfv::python
