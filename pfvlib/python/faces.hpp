// SPDX-License-Identifier: GPL-3.0-or-later
// Faces by their names.
#pragma once

#include "pfv/container.hpp"
#include "pfv/flow_model.hpp"

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace pfv::python {

namespace py = pybind11;

/// In the order in which a network numbers them as vertices of its cells.
std::vector<std::string> face_names(const Container& container);
/// Throws InputError for a name that the box or container does not have.
FaceCondition& condition_of(Box& box, const std::string& name);
int face_of(const Container& container, const std::string& name);
double position_of(const Box& box, const std::string& name);
double area_of(const Box& box, const std::string& name);
Patch patch_of(const Box& box, const std::string& name, const std::array<double, 4>& rectangle,
               const Boundary& boundary);

/// {name: mass} or {name: (mass, other_force)}; none: no pistons.
using Pistons = decltype(GrainDynamics::pistons);
Pistons pistons_of(const Container& container, py::handle given);

/// {name: value of the face}, of results that stand in the order of the faces.
template <class Results, class Convert>
py::dict by_face(const Container& container, const Results& results, const Convert& convert) {
  py::dict faces;
  std::size_t face = 0;
  for (const std::string& name : face_names(container)) faces[py::str(name)] = convert(results[face++]);
  return faces;
}

}  // namespace pfv::python
