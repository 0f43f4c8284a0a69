// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of a box by their names: the one place of the module that knows how the library keeps them.
#pragma once

#include "pfv/box.hpp"
#include "pfv/flow_model.hpp"

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace pfv::python {

namespace py = pybind11;

/// In the order in which a network numbers them as vertices of its cells.
std::vector<std::string> face_names(const Box& box);
/// Throws InputError for a name that the box does not have.
FaceCondition& condition_of(Box& box, const std::string& name);
double position_of(const Box& box, const std::string& name);
double area_of(const Box& box, const std::string& name);
Patch patch_of(const Box& box, const std::string& name, const std::array<double, 4>& rectangle,
               const Boundary& boundary);

/// {name: mass} or {name: (mass, other_force)}; none: no pistons.
using Pistons = decltype(GrainDynamics::pistons);
Pistons pistons_of(const Box& box, py::handle given);

/// {name: value of the face}, of results that stand in the order of the faces.
template <class Results, class Convert>
py::dict by_face(const Box& box, const Results& results, const Convert& convert) {
  py::dict faces;
  std::size_t face = 0;
  for (const std::string& name : face_names(box)) faces[py::str(name)] = convert(results[face++]);
  return faces;
}

}  // namespace pfv::python
