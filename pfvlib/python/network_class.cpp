// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Network: the pores and throats as arrays.
#include "network_class.hpp"

#include "arrays.hpp"
#include "classes.hpp"

#include <pybind11/stl.h>

namespace pfv::python {

NetworkArrays::NetworkArrays(PoreNetwork network, std::vector<std::string> walls)
    : network_(std::move(network)), walls_(std::move(walls)) {
  network_.cell_centres.colwise() += network_.origin;
  network_.pore_centres.colwise() += network_.origin;
}

void add_network_class(py::module_& module) {
  py::class_<NetworkArrays> network(module, "Network", R"(Pores and throats of a packing as arrays.

A cell is a tetrahedron of spheres and walls, a pore one cell or several of one centre, a throat what two pores
share. In cell_vertices k >= 0 is the sphere of row k (with outside="leave_out" of those inside the box, along
periodic axes sphere vertex_sphere[k]) and -1 - k the wall walls[k].)");
  const auto add = [&network](const char* name, auto PoreNetwork::*numbers, const char* doc) {
    network.def_property_readonly(name, [numbers](py::object self) {
      return view_of(self.cast<const NetworkArrays&>().get().*numbers, self);
    }, doc);
  };
  add("vertex_sphere", &PoreNetwork::vertex_sphere, "The sphere that a vertex k >= 0 stands for.");
  add("cell_vertices", &PoreNetwork::cell_vertices, "cells x 4, spheres first");
  add("cell_neighbours", &PoreNetwork::cell_neighbours, "cells x 4: the cell opposite each vertex; -1 outside the box");
  add("cell_centres", &PoreNetwork::cell_centres, "cells x 3: dual vertices, m");
  add("cell_pore", &PoreNetwork::cell_pore, "cells: the pore that each belongs to");
  add("pore_centres", &PoreNetwork::pore_centres, "pores x 3, m");
  add("throat_pores", &PoreNetwork::throat_pores, "throats x 2: the pores that each joins");
  add("throat_offsets", &PoreNetwork::throat_offsets,
      "throats x 3: from the second pore's centre to its image at the throat, m; empty without periodic axes");
  add("hidden", &PoreNetwork::hidden, "Spheres that are vertices of no cell.");
  network.def_property_readonly("walls", &NetworkArrays::walls, "Names of the faces.");
  network.def_property_readonly("cells", [](const NetworkArrays& self) { return self.get().cells(); }, "Their number.");
  network.def_property_readonly("pores", [](const NetworkArrays& self) { return self.get().pores(); }, "Their number.");
  network.def_property_readonly("throats", [](const NetworkArrays& self) { return self.get().throats(); },
                                "Their number.");
}

}  // namespace pfv::python
