// SPDX-License-Identifier: GPL-3.0-or-later
#include "faces.hpp"

namespace pfv::python {

std::vector<std::string> face_names(const Container& container) {
  std::vector<std::string> names;
  for (const ContainerFace& face : container.faces) names.push_back(face.name);
  return names;
}

int face_of(const Container& container, const std::string& name) {
  if (const std::optional<int> face = container.face_named(name)) return *face;
  std::string names;
  for (const std::string& known : face_names(container)) names += (names.empty() ? "" : ", ") + known;
  throw InputError("there is no face '" + name + "': give " + names);
}

FaceCondition& condition_of(Box& box, const std::string& name) { return box[named<Face>(name)]; }

double position_of(const Box& box, const std::string& name) { return box.position(named<Face>(name)); }

double area_of(const Box& box, const std::string& name) { return box.area(named<Face>(name)); }

Patch patch_of(const Box&, const std::string& name, const std::array<double, 4>& rectangle,
               const Boundary& boundary) {
  return {named<Face>(name), rectangle, boundary};
}

namespace {

Piston piston_of(py::handle given) {
  if (!py::isinstance<py::tuple>(given)) return {given.cast<double>(), 0.0};
  const auto [mass, other_force] = given.cast<std::pair<double, double>>();
  return {mass, other_force};
}

}  // namespace

Pistons pistons_of(const Container& container, py::handle given) {
  Pistons pistons(container.faces.size());
  if (given.is_none()) return pistons;
  if (!py::isinstance<py::dict>(given)) throw py::type_error("pistons: give a dict {face: mass}");
  for (const auto& [name, piston] : py::reinterpret_borrow<py::dict>(given)) {
    const auto face = static_cast<std::size_t>(face_of(container, name.cast<std::string>()));
    try {
      pistons[face] = piston_of(piston);
    } catch (const py::cast_error&) {
      throw py::type_error("pistons: give each face a mass (kg) or a tuple (mass, other_force) (kg, N)");
    }
  }
  return pistons;
}

}  // namespace pfv::python
