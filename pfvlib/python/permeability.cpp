// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.permeability
#include "arrays.hpp"
#include "classes.hpp"
#include "errors.hpp"
#include "faces.hpp"
#include "grains.hpp"
#include "keywords.hpp"

#include "pfv/darcy_grid.hpp"

namespace pfv::python {
namespace {

using namespace py::literals;

/// A fall of 1 Pa drives fluid along the axis.
Box sample(py::handle bounds, int along, const std::string& wall, const std::string& periodic) {
  Box box = make_box(bounds, wall, py::str(periodic));
  if (box.periodic[static_cast<std::size_t>(along)]) {
    box.pressure_gradient[along] = -1.0 / (box.upper[along] - box.lower[along]);
    return box;
  }
  box.faces[2 * along].boundary = Boundary::pressure(1.0);
  box.faces[2 * along + 1].boundary = Boundary::pressure(0.0);
  return box;
}

Report report_of(const Box& box, const Settings& settings, const Packing& packing) {
  const py::gil_scoped_release released;
  const auto model = make_flow(box, settings.fluid, settings.options, settings.grid());
  model->evaluate(packing);
  return model->report();
}

void warn_of(const Report& report, const Packing& packing) {
  for (const std::string& reason : report.outside_range)
    warn("AccuracyWarning", "the permeability's estimated error may not hold: " + reason);
  if (const double mean = 2.0 * packing.radii.mean(); mean > largest_usual_diameter)
    warn("PackingWarning", "the mean diameter is " + std::string(py::str(py::float_(mean))) +
                               " m; lengths are in m: are these in mm?");
}

double permeability(py::object positions, py::object radii, py::object box, py::object axis,
                    const std::string& periodic, const std::string& wall, py::object ids, const py::kwargs& keywords) {
  const Grains grains({positions, radii, py::none(), py::none(), ids, py::none(), py::none()});
  Settings settings;
  settings.options.forces = false;
  settings.options.amg_from = amg_from_for_one_solution;
  read_keywords("permeability()", keywords, all_keywords(), settings);
  settle(settings);
  check(settings);
  const Report report = report_of(sample(box, axis_of(axis), wall, periodic), settings, grains.packing());
  if (!report.permeability)
    throw InputError("no permeability in this box: it takes an incompressible fluid, grains at rest and a fall of "
                     "pressure along one axis");
  warn_of(report, grains.packing());
  return *report.permeability;
}

}  // namespace

void add_permeability(py::module_& module) {
  const std::string doc = R"(Permeability of a packing, m2.

    pfv.permeability(positions, radii, [[0, 1], [0, 1], [0, 1]])

positions: N x 3, m; radii: N, m
box: [[xlo, xhi], [ylo, yhi], [zlo, zhi]], m
axis: of the fall of pressure, "x", "y", "z" or 0, 1, 2
periodic: axes along which the packing repeats, "xy" for instance
wall: of the other sides: "no_slip", the walls of a container; "symmetry", cuts through a wider bed, whose spheres
    reach over them. What it does to the result: doc/user_guide.md
ids: N whole numbers, unique, which errors name (None: the numbers of the rows, from 0)

It is what `pfv solve --face zlo:pressure=1 --face zhi:pressure=0` reports, to the last digit; for
its estimated error take `Flow.report()["permeability_error"]`. Warns (AccuracyWarning) where that may not hold, and
(PackingWarning) where lengths look like mm.
Cost: a network, its factor, one solve. Raises InputError with the ids of the spheres, SolverError, TypeError for an
unknown keyword. Keywords, as for Flow:
)" + help_of(all_keywords());
  module.def("permeability", &permeability, doc.c_str(), "positions"_a, "radii"_a, "box"_a, py::kw_only(),
             "axis"_a = "z", "periodic"_a = "", "wall"_a = name_of(Wall::no_slip), "ids"_a = py::none());
}

}  // namespace pfv::python
