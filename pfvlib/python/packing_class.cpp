// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Packing: the spheres of a file, read and written.
#include "arrays.hpp"
#include "classes.hpp"
#include "errors.hpp"
#include "grains.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/packing_file.hpp"

#include <pybind11/stl.h>

namespace pfv::python {
namespace {

using namespace py::literals;

const PackingFile& file_of(py::handle self) { return self.cast<const PackingFile&>(); }
const PackingArrays& arrays_of(py::handle self) { return file_of(self).packing; }

/// None where a file has no such columns.
template <class Matrix>
py::object rows_or_none(const Matrix& matrix, py::handle self) {
  return matrix.cols() == 0 ? py::object(py::none()) : view_of(matrix, self);
}

/// [[xlo, xhi], [ylo, yhi], [zlo, zhi]]
py::object rows_of(const PackingBounds& bounds) {
  py::array_t<double> rows({3, 2});
  auto at = rows.mutable_unchecked<2>();
  for (int axis = 0; axis < 3; ++axis) {
    at(axis, 0) = bounds.lower[axis];
    at(axis, 1) = bounds.upper[axis];
  }
  return std::move(rows);
}

PackingFile file_of_arrays(const GivenGrains& given, py::object bounds, py::object periodic, py::object tilt,
                           std::optional<std::int64_t> step) {
  const Grains grains(given);
  const Packing spheres = grains.packing();
  PackingFile file;
  file.packing.ids = spheres.ids;
  if (given.ids.is_none()) file.packing.ids.array() += 1;  // files count from 1
  file.packing.positions = spheres.positions;
  file.packing.radii = spheres.radii;
  file.packing.velocities = spheres.velocities;
  file.packing.angular_velocities = spheres.angular_velocities;
  file.step = step;
  if (bounds.is_none()) return file;
  Box box = py::isinstance<Box>(bounds) ? bounds.cast<Box>() : make_box(bounds, name_of(Wall::no_slip), periodic);
  if (!py::isinstance<Box>(bounds)) box.tilt = vector_of(tilt, "tilt");
  check(box);
  file.bounds = PackingBounds{box.lower, box.upper, box.periodic, box.tilt, {}};
  return file;
}

void warn_of(const std::vector<std::string>& remarks, const std::string& path) {
  for (const std::string& remark : remarks) warn("PackingWarning", path + ": " + remark);
}

void add_arrays(py::class_<PackingFile>& packing) {
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
  packing.def("__len__", [](const PackingFile& self) { return self.packing.ids.size(); });
  packing.def("__repr__", [](const PackingFile& self) {
    const std::string step = self.step ? ", step " + std::to_string(*self.step) : "";
    return "<pfv.Packing of " + std::to_string(self.packing.ids.size()) + " spheres" + step + ">";
  });
}

void add_room(py::class_<PackingFile>& packing) {
  packing.def_property_readonly("bounds", [](const PackingFile& self) {
    return self.bounds ? rows_of(*self.bounds) : py::object(py::none());
  }, "[[xlo, xhi], [ylo, yhi], [zlo, zhi]], m, of the simulation box that a dump or a data file states, or None");
  packing.def_property_readonly("periodic", [](const PackingFile& self) {
    std::string axes;
    for (std::size_t axis = 0; self.bounds && axis < 3; ++axis)
      if (self.bounds->periodic[axis]) axes += "xyz"[axis];
    return axes;
  }, "Axes along which that box is periodic: \"xy\".");
  packing.def_property_readonly("tilt", [](const PackingFile& self) {
    return array_of(self.bounds ? self.bounds->tilt : Eigen::Vector3d::Zero());
  }, "xy, xz, yz of a tilted box, m.");
  packing.def_property_readonly("extent", [](const PackingFile& self) { return rows_of(extent_of(self.packing)); },
                                "Bounds of the smallest box that holds the spheres, m: `pfv solve --box auto`.");
  packing.def_property_readonly("step", [](const PackingFile& self) { return self.step; },
                                "Time step of a dump, or None.");
  packing.def_property_readonly("remarks", [](const PackingFile& self) { return self.remarks; },
                                "What was assumed in reading, a sentence each.");
}

const char* const packing_text = R"(Spheres: arrays with a row for each, of a file or of your own.

    pfv.write_packing("grains.dump", pfv.Packing(x, r, bounds=[[0, 1], [0, 1], [0, 2]], periodic="xy"))

positions: N x 3, m; radii: N, m; velocities: N x 3, m/s; angular_velocities: N x 3, rad/s
ids: N whole numbers, unique (None: from 1)
bounds: of a simulation box, [[xlo, xhi], [ylo, yhi], [zlo, zhi]], m, or a Box, with its periodic axes and tilt
periodic, tilt: as for Box; step: number of a time step, which a dump holds

Copies the arrays. Raises InputError for arrays of other shapes.)";

void add_init(py::class_<PackingFile>& packing) {
  packing.def(py::init([](py::object positions, py::object radii, py::object velocities, py::object angular_velocities,
                          py::object ids, py::object bounds, py::object periodic, py::object tilt,
                          std::optional<std::int64_t> step) {
                return file_of_arrays({positions, radii, velocities, angular_velocities, ids, py::none(), py::none()},
                                      bounds, periodic, tilt, step);
              }),
              "positions"_a, "radii"_a, "velocities"_a = py::none(), py::kw_only(), "angular_velocities"_a = py::none(),
              "ids"_a = py::none(), "bounds"_a = py::none(), "periodic"_a = "",
              "tilt"_a = py::make_tuple(0.0, 0.0, 0.0), "step"_a = py::none());
}

void add_reader(py::module_& module) {
  module.def("read_packing", [](py::object given, py::object snapshot, py::object unit) {
               const std::string path = path_of(given);
               const PackingChoice choice{py::str(snapshot), length_unit(py::str(unit))};
               PackingFile file = [&] {
                 const py::gil_scoped_release released;
                 return read_packing_file(path, choice);
               }();
               warn_of(file.remarks, path);
               return file;
             }, "path"_a, py::kw_only(), "snapshot"_a = "last", "length_unit"_a = 1.0,
             R"(The spheres of a file in any format that `pfv solve` reads (doc/user_guide.md).

snapshot: of a dump: "last", a time step, "time=T", or where there is no such step a number from 1
length_unit: of the file: "mm", "cm", ..., or what it is in m

Warns (PackingWarning) of what was assumed in reading. Raises InputError that names file, line and field.)");
}

void add_writer(py::module_& module) {
  module.def("write_packing", [](py::object given, const PackingFile& packing, std::optional<std::string> format,
                                 std::optional<double> density) {
               const std::string path = path_of(given);
               PackingOutput output;
               if (format) output.format = named<PackingFormat>(*format);
               output.density = density;
               const py::gil_scoped_release released;
               return write_packing_file(path, packing, output);
             }, "path"_a, "packing"_a, py::kw_only(), "format"_a = py::none(), "density"_a = py::none(),
             R"(Writes spheres to a file, as `pfv convert` does: read_packing gives the same numbers bit by bit.

packing: a Packing, read from a file or of arrays of your own
format: "csv" (table), "yade" (x y z r), "dump", "data" (LIGGGHTS), "vtu" (ParaView); None: that of the file's ending,
    .csv, .txt, .dump, .data, .vtu
density: of the grains, kg/m3, in a data file (None: 2500)

Returns what the format does not hold and what was assumed, a sentence each. The file is whole or absent. Raises
InputError for an ending without a format or a folder that is not there, FileError where it cannot be written.)");
}

}  // namespace

void add_packing_class(py::module_& module) {
  py::class_<PackingFile> packing(module, "Packing", packing_text);
  add_init(packing);
  add_arrays(packing);
  add_room(packing);
  add_reader(module);
  add_writer(module);
  module.def("dense_packing", [](int spheres, double solid_fraction, double spread, unsigned seed, int sweeps) {
               return PackingFile{dense_packing(spheres, solid_fraction, spread, seed, sweeps), {}, {}, {}};
             }, "spheres"_a, "solid_fraction"_a = 0.6, "spread"_a = 0.2, "seed"_a = 1, "sweeps"_a = 400,
             py::call_guard<py::gil_scoped_release>(),
             R"(A dense random packing in the unit cube, for trials: same arguments, same packing.

spread: radii are spread evenly over 1 +- this times their mean)");
}

}  // namespace pfv::python
