// SPDX-License-Identifier: GPL-3.0-or-later
#include "conditions.hpp"

#include "keywords.hpp"

#include "pfv/words.hpp"

#include <cmath>
#include <memory>

namespace pfv::python {
namespace {

/// A function of Python. The copies that the library makes of it share one reference, so that none of them
/// touches the interpreter's counts without its lock.
std::function<double(const Eigen::Vector3d&, double)> profile_of(const py::function& function) {
  const std::shared_ptr<py::function> shared(new py::function(function), [](py::function* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
  return [shared](const Eigen::Vector3d& place, double time) {
    const py::gil_scoped_acquire lock;
    const py::object pressure = (*shared)(array_of(place), time);
    const double value = PyFloat_AsDouble(pressure.ptr());
    if (PyErr_Occurred()) throw py::error_already_set();
    if (!std::isfinite(value)) throw InputError("the function of a pressure returned a number that is not finite");
    return value;
  };
}

Boundary boundary_of(const BoundaryKind& kind, py::handle value) {
  Boundary boundary{kind.kind, 0.0, {}};
  if (!kind.symbol) return boundary;
  if (kind.kind == Boundary::Kind::pressure && py::isinstance<py::function>(value))
    boundary.profile = profile_of(py::reinterpret_borrow<py::function>(value));
  else
    boundary.value = number_of(value, kind.name);
  return boundary;
}

std::vector<std::string> boundary_names() {
  std::vector<std::string> names;
  for (const BoundaryKind& kind : boundary_kinds) names.emplace_back(kind.name);
  return names;
}

}  // namespace

std::vector<std::array<double, 2>> intervals_of(py::handle given, const char* name, py::ssize_t count) {
  const auto numbers = reals_of(given, name);
  if (numbers.ndim() != 2 || numbers.shape(0) != count || numbers.shape(1) != 2)
    throw InputError(std::string(name) + ": give " + std::to_string(count) + " intervals [lower, upper], m");
  std::vector<std::array<double, 2>> intervals;
  for (py::ssize_t k = 0; k < count; ++k) intervals.push_back({numbers.at(k, 0), numbers.at(k, 1)});
  return intervals;
}

std::array<bool, 3> periodic_of(py::handle given) {
  std::array<bool, 3> periodic{};
  for (const py::handle part : given) {
    const auto axis = part.cast<std::string>();
    if (axis == "," || axis == " ") continue;
    if (axis != "x" && axis != "y" && axis != "z")
      throw InputError("periodic: there is no axis '" + axis + "': give some of x, y, z");
    bool& own = periodic[static_cast<std::size_t>(axis[0] - 'x')];
    if (own) throw InputError("periodic: axis " + axis + " occurs twice");
    own = true;
  }
  return periodic;
}

std::string periodic_text(const std::array<bool, 3>& periodic) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (periodic[axis]) text += "xyz"[axis];
  return text;
}

std::optional<Boundary> boundary_among(const std::string& function, const py::kwargs& keywords) {
  std::optional<Boundary> boundary;
  for (const BoundaryKind& kind : boundary_kinds) {
    if (!keywords.contains(kind.name)) continue;
    if (!kind.symbol && !py::bool_(keywords[kind.name])) continue;  // sealed=False
    if (boundary) throw InputError(function + ": give one of " + names_of_boundaries());
    boundary = boundary_of(kind, keywords[kind.name]);
  }
  return boundary;
}

Boundary required_boundary(const std::string& function, const py::kwargs& keywords) {
  for (const auto& item : keywords)
    require_known(function, item.first.cast<std::string>(), boundary_names());
  const auto boundary = boundary_among(function, keywords);
  if (!boundary) throw InputError(function + ": give one of " + list_boundary_kinds([](const BoundaryKind& one) {
      return one.name + (one.symbol ? std::string(" (") + one.unit + ")" : "=True");
    }));
  return *boundary;
}

py::dict dict_of(const Boundary& boundary) {
  py::dict dict;
  for (const BoundaryKind& kind : boundary_kinds)
    if (kind.kind == boundary.kind)
      dict[kind.name] = !kind.symbol ? py::object(py::bool_(true))
                        : boundary.profile ? py::object(py::str("a function"))
                                           : py::object(py::float_(boundary.value));
  return dict;
}

std::string boundary_lines() {
  return list_boundary_kinds([](const BoundaryKind& one) {
    if (!one.symbol) return std::string(one.name) + ": True: " + one.note;
    const char* const function = "; a number or a function of (place, time): 3 numbers (m), s.\n    It is called for each "
                                 "pore of the face at each solve, with the interpreter's lock";
    return std::string(one.name) + ": " + one.unit + ", " + one.note +
           (one.kind == Boundary::Kind::pressure ? function : "");
  }, "\n");
}

void require_conditions(const py::kwargs& keywords, const std::vector<std::string>& beside) {
  std::vector<std::string> known = boundary_names();
  known.insert(known.end(), beside.begin(), beside.end());
  for (const auto& item : keywords) require_known("face()", item.first.cast<std::string>(), known);
}

}  // namespace pfv::python
