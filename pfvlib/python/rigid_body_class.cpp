// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.RigidBody
#include "arrays.hpp"
#include "classes.hpp"

#include "pfv/flow_model.hpp"

namespace pfv::python {
namespace {

const char* const rigid_body_text =
    R"(How a rigid body of several spheres yields to forces; a value that does not change.

    pfv.RigidBody([[0, 0, -1e-3], [0, 0, 1e-3]], masses=2e-5, inertias=(3e-11, 3e-11, 1e-11))

arms: n x 3, m, from its centre of mass to each of its spheres, in the order of the packing
masses: kg, along x, y, z, or one number; inf along what it is held
inertias: kg m2, 3 numbers, about its principal axes; inf about what it does not turn
axes: 3 x 3, a row for each principal axis, of length 1 (None: x, y, z)
other_force: N, other_torque: N m about its centre of mass: what acts on it beside the forces on its spheres

The step that it is given to raises InputError for arms that are not one for each sphere, masses or inertias that are
not above 0, axes that are not at right angles.)";

/// One number serves all three axes.
Eigen::Vector3d masses_of(py::handle given) {
  const auto numbers = reals_of(given, "masses");
  return numbers.ndim() == 0 ? Eigen::Vector3d::Constant(*numbers.data()) : vector_of(given, "masses");
}

Eigen::Matrix3d axes_of(py::handle given) {
  if (given.is_none()) return Eigen::Matrix3d::Identity();
  return columns_of(rows_of_three(given, "axes", 3));
}

}  // namespace

void add_rigid_body_class(py::module_& module) {
  using namespace py::literals;
  py::class_<RigidBody> body(module, "RigidBody", rigid_body_text);
  body.def(py::init([](py::object arms, py::object masses, py::object inertias, py::object axes, py::object other_force,
                       py::object other_torque) {
             return RigidBody{columns_of(rows_of_three(arms, "arms")), masses_of(masses),
                              vector_of(inertias, "inertias"), axes_of(axes),
                              vector_of(other_force, "other_force"), vector_of(other_torque, "other_torque")};
           }), "arms"_a, py::kw_only(), "masses"_a, "inertias"_a, "axes"_a = py::none(),
           "other_force"_a = py::make_tuple(0.0, 0.0, 0.0), "other_torque"_a = py::make_tuple(0.0, 0.0, 0.0));
  body.def_property_readonly("arms", [](const RigidBody& self) { return array_of(Eigen::Matrix3Xd(self.arms)); },
                             "n x 3, m; a copy.");
  body.def_property_readonly("masses", [](const RigidBody& self) { return array_of(self.masses); }, "kg, 3 numbers.");
  body.def_property_readonly("inertias", [](const RigidBody& self) { return array_of(self.inertias); },
                             "kg m2, 3 numbers.");
  body.def("__repr__", [](const RigidBody& self) {
    return "pfv.RigidBody(of " + std::to_string(self.arms.cols()) + " spheres)";
  });
}

}  // namespace pfv::python
