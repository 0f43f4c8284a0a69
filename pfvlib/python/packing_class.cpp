// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Packing: the spheres of a file.
#include "arrays.hpp"
#include "classes.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/packing_file.hpp"

namespace pfv::python {
namespace {

const PackingArrays& arrays_of(py::handle self) { return self.cast<const PackingArrays&>(); }

/// None where a file has no such columns.
template <class Matrix>
py::object rows_or_none(const Matrix& matrix, py::handle self) {
  return matrix.cols() == 0 ? py::object(py::none()) : view_of(matrix, self);
}

}  // namespace

void add_packing_class(py::module_& module) {
  using namespace py::literals;
  py::class_<PackingArrays> packing(module, "Packing", "The spheres of a file: arrays with a row for each.");
  packing.def_property_readonly("ids", [](py::object self) { return view_of(arrays_of(self).ids, self); }, "N");
  packing.def_property_readonly("positions", [](py::object self) { return view_of(arrays_of(self).positions, self); },
                                "N x 3, m");
  packing.def_property_readonly("radii", [](py::object self) { return view_of(arrays_of(self).radii, self); }, "N, m");
  packing.def_property_readonly("velocities",
                                [](py::object self) { return rows_or_none(arrays_of(self).velocities, self); },
                                "N x 3, m/s, or None");
  packing.def_property_readonly("angular_velocities",
                                [](py::object self) { return rows_or_none(arrays_of(self).angular_velocities, self); },
                                "N x 3, rad/s, or None");
  packing.def("__len__", [](const PackingArrays& self) { return self.ids.size(); });
  module.def("read_packing", [](py::object given, py::object snapshot, double length_unit) {
               const std::string path = path_of(given);
               const PackingChoice choice{py::str(snapshot), length_unit};
               const py::gil_scoped_release released;
               return read_packing_file(path, choice).packing;
             }, "path"_a, py::kw_only(), "snapshot"_a = "last", "length_unit"_a = 1.0,
             R"(The spheres of a file in any format that `pfv solve` reads (doc/user_guide.md).

snapshot: of a dump: "last", a time step, "time=T", or where there is no such step a number from 1
length_unit: of the file, m

Raises InputError that names file, line and field.)");
  module.def("dense_packing", &dense_packing, "spheres"_a, "solid_fraction"_a = 0.6, "spread"_a = 0.2, "seed"_a = 1,
             "sweeps"_a = 400, py::call_guard<py::gil_scoped_release>(),
             R"(A dense random packing in the unit cube, for trials: same arguments, same packing.

spread: radii are spread evenly over 1 +- this times their mean)");
}

}  // namespace pfv::python
