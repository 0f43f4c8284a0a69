// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.contact_stresses, pfv.inertial_stresses
#include "classes.hpp"
#include "grains.hpp"

#include "pfv/grain_stresses.hpp"

namespace pfv::python {
namespace {

using namespace py::literals;

SphereTensors contact_stresses_of(py::object positions, py::object radii, py::handle spheres, py::handle points,
                                  py::handle forces) {
  const Grains grains({positions, radii, py::none(), py::none(), py::none(), py::none(), py::none()});
  const auto touched = rows_of_three(points, "points"), pushed = rows_of_three(forces, "forces");
  const auto rows = ids_of(spheres, touched.shape(0));
  return contact_stresses(grains.packing(), {vector_of(rows), columns_of(touched), columns_of(pushed)});
}

SphereTensors inertial_stresses_of(py::object positions, py::object radii, py::object velocities, py::handle masses,
                                   py::object frame) {
  const Grains grains({positions, radii, velocities, py::none(), py::none(), py::none(), py::none()});
  const auto each = one_each(masses, "masses", grains.count());
  const Packing packing = grains.packing();
  return inertial_stresses(packing, vector_of(each),
                           frame.is_none() ? mean_velocity(packing, vector_of(each)) : vector_of(frame, "frame"));
}

}  // namespace

void add_grain_stresses(py::module_& module) {
  module.def("contact_stresses", [](py::object positions, py::object radii, py::handle spheres, py::handle points,
                                    py::handle forces) {
               return array_of(contact_stresses_of(positions, radii, spheres, points, forces));
             }, "positions"_a, "radii"_a, "spheres"_a, "points"_a, "forces"_a,
             R"(Mean stress that contacts cause in each sphere, N x 6: xx, yy, zz, xy, xz, yz, Pa, tension positive.

spheres: the row of the sphere that each force acts on, C; points, forces: C x 3, m and N. A contact of two spheres is
two rows, with opposite forces; across a periodic side each has its point beside its own sphere. The moment of the
forces about the centre over the sphere's volume (Catalano 2012, eq. 2.18). Raises InputError for arrays that do not go
together, a row that is not there or a number that is not finite. Cost: one pass over the contacts.)");
  module.def("inertial_stresses", [](py::object positions, py::object radii, py::object velocities, py::handle masses,
                                     py::object frame) {
               return array_of(inertial_stresses_of(positions, radii, velocities, masses, frame));
             }, "positions"_a, "radii"_a, "velocities"_a, "masses"_a, "frame"_a = py::none(),
             R"(What the motion of each sphere adds to the stress of the packing, N x 6: -m v v over its volume, Pa.

masses: N, kg; velocities: N x 3, m/s, taken relative to `frame`, which is that of the centre of mass unless it is
given. Raises InputError for arrays of another shape.)");
}

}  // namespace pfv::python
