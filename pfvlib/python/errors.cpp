// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors.hpp"

#include "pfv/error.hpp"

namespace py = pybind11;

namespace pfv::python {
namespace {

py::tuple spheres_of(const Culprits& culprits) {
  py::list spheres;
  for (const std::int64_t id : culprits.spheres) spheres.append(id);
  return py::tuple(spheres);
}

py::tuple places_of(const Culprits& culprits) {
  py::list places;
  for (const auto& [x, y, z] : culprits.places) places.append(py::make_tuple(x, y, z));
  return py::tuple(places);
}

void raise(const char* name, const Error& error) {
  const py::object type = py::module_::import("pfv._errors").attr(name);
  const py::object raised = type(error.what());
  raised.attr("spheres") = spheres_of(error.culprits());
  raised.attr("places") = places_of(error.culprits());
  PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise("InputError", error);
    } catch (const SolverError& error) {
      raise("SolverError", error);
    } catch (const FileError& error) {
      raise("FileError", error);
    } catch (const Error& error) {
      raise("Error", error);
    }
  });
}

void warn(const char* warning, const std::string& text) {
  const py::object type = py::module_::import("pfv._errors").attr(warning);
  if (PyErr_WarnEx(type.ptr(), text.c_str(), 1) < 0) throw py::error_already_set();
}

}  // namespace pfv::python
