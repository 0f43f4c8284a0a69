// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled part of the Python module pfv: functions of the library, and no physics of its own.
#include "classes.hpp"
#include "errors.hpp"
#include "keywords.hpp"

#include "pfv/io.hpp"
#include "pfv/version.hpp"

PYBIND11_MODULE(_pfv, module) {
  namespace py = pybind11;
  using namespace pfv::python;
  // users see one module, also in what help() prints
  module.attr("__name__") = "pfv";
  module.attr("__version__") = pfv::version;
  translate_errors();
  add_box_class(module);
  add_container_class(module);
  add_fluid_class(module);
  add_packing_class(module);
  add_network_class(module);
  add_rigid_body_class(module);
  add_flow_class(module);
  add_permeability(module);
  add_grain_stresses(module);
  module.def("settings", &table_of_settings,
             "The settings that Flow and permeability take as keywords: a list of dicts with name, group, values, "
             "unit, default, models (that read it), help.");
  module.def("citation", &pfv::citation, "The papers to cite, as text.");
  module.attr("__name__") = "pfv._pfv";
}
