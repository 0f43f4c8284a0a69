// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Fluid
#include "arrays.hpp"
#include "classes.hpp"
#include "keywords.hpp"

#include <pybind11/stl.h>

namespace pfv::python {

void add_fluid_class(py::module_& module) {
  const std::string doc =
      "The fluid in the pores; a value that does not change.\n\n"
      "    pfv.Fluid(viscosity=1e-3, gravity=(0, 0, -9.81))\n" + help_of(fluid_keywords()) +
      "\n\nPressures are the piezometric excess, p = p_abs - density gravity . x. Raises InputError for a value out "
      "of range.";
  py::class_<Fluid> fluid(module, "Fluid", doc.c_str());
  fluid.def(py::init([](const py::kwargs& keywords) {
    Settings settings;
    read_keywords("Fluid()", keywords, fluid_keywords(), settings);
    check(settings.fluid);
    return settings.fluid;
  }));
  fluid.def_readonly("viscosity", &Fluid::viscosity, "Pa s");
  fluid.def_readonly("density", &Fluid::density, "kg/m3");
  fluid.def_property_readonly("gravity", [](const Fluid& self) { return array_of(self.gravity); }, "m/s2, 3 numbers");
  fluid.def_readonly("bulk_modulus", &Fluid::bulk_modulus, "Pa; None: incompressible");
  fluid.def("__repr__", [](const Fluid& self) {
    Settings settings;
    settings.fluid = self;
    std::string text;
    for (const std::string& name : fluid_keywords())
      text += (text.empty() ? "" : ", ") + name + "=" + setting_named(name)->text(settings);
    return "pfv.Fluid(" + text + ")";
  });
}

}  // namespace pfv::python
