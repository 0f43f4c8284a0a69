// SPDX-License-Identifier: GPL-3.0-or-later
// What boxes and containers take in common: boundaries of faces, patches and regions among keywords.
#pragma once

#include "arrays.hpp"

#include "pfv/box.hpp"

#include <optional>
#include <string>
#include <vector>

namespace pfv::python {

/// One for each axis: n x 2 numbers, as lower and upper. Throws InputError for another shape.
std::vector<std::array<double, 2>> intervals_of(py::handle given, const char* name, py::ssize_t count);

/// "xy", "x,y", ("x", "y"): axes along which the packing repeats. Throws InputError for another one.
std::array<bool, 3> periodic_of(py::handle given);
/// "xy"
std::string periodic_text(const std::array<bool, 3>& periodic);

/// The boundary among the keywords of a face, patch or region. Throws InputError for several.
std::optional<Boundary> boundary_among(const std::string& function, const py::kwargs& keywords);
/// The only keyword is the boundary, which must be there.
Boundary required_boundary(const std::string& function, const py::kwargs& keywords);
/// {"pressure": 5.0}, {"sealed": True}, ...
py::dict dict_of(const Boundary& boundary);
/// Throws TypeError for keywords of a face that are neither its boundary nor these.
void require_conditions(const py::kwargs& keywords, const std::vector<std::string>& beside);

/// The kinds of boundaries in a docstring, a line for each.
std::string boundary_lines();

inline const std::string region_text = R"(Gives the pores between two corners (m) a boundary that fluid crosses.

Returns the object.
one of )" + names_of_boundaries() + R"(: as for a face
With lower = upper it is the pore nearest to that point.)";

/// Of a box or container; returns it.
template <class Holder>
py::object region_added(py::object self, py::object lower, py::object upper, const py::kwargs& keywords) {
  self.cast<Holder&>().regions.push_back(
      {vector_of(lower, "lower"), vector_of(upper, "upper"), required_boundary("region()", keywords)});
  return self;
}

}  // namespace pfv::python
