// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Container
#include "arrays.hpp"
#include "classes.hpp"
#include "conditions.hpp"
#include "faces.hpp"

#include "pfv/io.hpp"
#include "pfv/words.hpp"

#include <Eigen/Geometry>
#include <pybind11/stl.h>
#include <sstream>

namespace pfv::python {
namespace {

using namespace py::literals;

/// A dict goes through the text of a file, so that the two are read alike.
Container read(py::handle given) {
  if (!py::isinstance<py::dict>(given)) return read_container(path_of(given));
  const auto as_list = py::cpp_function([](py::object array) { return array.attr("tolist")(); });
  const py::object text = py::module_::import("json").attr("dumps")(given, "default"_a = as_list);
  return container_of_json(text.cast<std::string>(), "Container()");
}

Container make_container(py::handle given, const std::string& wall, py::handle periodic, py::handle gradient) {
  Container container = read(given);
  for (ContainerFace& face : container.faces) face.wall = named<Wall>(wall);
  container.periodic = periodic_of(periodic);
  container.pressure_gradient = vector_of(gradient, "gradient");
  check(container);
  return container;
}

// ------------------------------------------------------------------------------------------ faces

const std::vector<std::string> container_conditions{"wall", "velocity", "angular_velocity", "spin", "pivot", "may_bound_nothing"};

/// A number is the speed along a plane's inward normal.
Eigen::Vector3d velocity_of(const ContainerFace& face, py::handle given) {
  if (reals_of(given, "velocity").ndim() > 0) return vector_of(given, "velocity");
  if (!face.surface.is_plane())
    throw InputError("face " + face.name + ": a cylinder has no normal to move along; give its velocity as 3 numbers, or spin");
  return -number_of(given, "velocity") * face.surface.normal;
}

void set_spin(ContainerFace& face, double spin) {
  if (face.surface.is_plane()) throw InputError("face " + face.name + ": spin is a cylinder's; give angular_velocity");
  face.angular_velocity = spin * face.surface.axis;
  face.pivot = face.surface.point;
}

/// Only what is named changes.
void set_container_face(Container& container, const std::string& name, const py::kwargs& keywords) {
  ContainerFace& changed = container.faces[static_cast<std::size_t>(face_of(container, name))];
  ContainerFace face = changed;
  require_conditions(keywords, container_conditions);
  if (const auto boundary = boundary_among("face()", keywords)) face.boundary = *boundary;
  const auto given = [&](const char* key) { return keywords.contains(key); };
  if (given("wall")) face.wall = named<Wall>(py::str(keywords["wall"]));
  if (given("velocity")) face.velocity = velocity_of(face, keywords["velocity"]);
  if (given("spin")) set_spin(face, number_of(keywords["spin"], "spin"));
  if (given("angular_velocity")) face.angular_velocity = vector_of(keywords["angular_velocity"], "angular_velocity");
  if (given("pivot")) face.pivot = vector_of(keywords["pivot"], "pivot");
  if (given("may_bound_nothing")) face.may_bound_nothing = py::bool_(keywords["may_bound_nothing"]);
  changed = face;
}

/// Another place of the same kind of surface; what is None stays.
void place_plane(ContainerFace& face, py::handle inward_normal, py::handle offset) {
  const Eigen::Vector3d inward =
      inward_normal.is_none() ? Eigen::Vector3d(-face.surface.normal) : vector_of(inward_normal, "inward_normal");
  const double length = inward.norm();
  if (!(length > 0.0)) throw InputError("face " + face.name + ": inward_normal has no length");
  if (inward_normal.is_none() == false && offset.is_none())
    throw InputError("face " + face.name + ": a new inward_normal needs the offset that belongs to it");
  face.surface.normal = -inward / length;
  if (!offset.is_none()) face.surface.offset = -number_of(offset, "offset") / length;
  face.guide = inward / length;
}

void place_cylinder(ContainerFace& face, py::handle axis, py::handle point, py::handle radius) {
  Surface& shape = face.surface;
  shape = Surface::cylinder(axis.is_none() ? shape.axis : vector_of(axis, "axis"),
                            point.is_none() ? shape.point : vector_of(point, "point"),
                            radius.is_none() ? shape.radius : number_of(radius, "radius"));
}

py::object place(py::object self, const std::string& name, py::object inward_normal, py::object offset, py::object axis,
                 py::object point, py::object radius) {
  auto& container = self.cast<Container&>();
  Container changed = container;
  ContainerFace& face = changed.faces[static_cast<std::size_t>(face_of(container, name))];
  const bool plane = !inward_normal.is_none() || !offset.is_none();
  const bool cylinder = !axis.is_none() || !point.is_none() || !radius.is_none();
  if (plane == cylinder || plane != face.surface.is_plane())
    throw InputError("face " + name + (face.surface.is_plane() ? " is a plane: give inward_normal and offset, or the offset"
                                                               : " is a cylinder: give axis, point or radius"));
  if (plane) place_plane(face, inward_normal, offset);
  else place_cylinder(face, axis, point, radius);
  container = std::move(changed);
  return self;
}

py::dict faces_and_places_of(const Container& container) {
  py::dict faces;
  for (const ContainerFace& face : container.faces) {
    py::dict condition = dict_of(face.boundary);
    const Surface& surface = face.surface;
    if (surface.is_plane()) {
      condition["inward_normal"] = array_of(Eigen::Vector3d(-surface.normal));
      condition["offset"] = -surface.offset;
    } else {
      condition["axis"] = array_of(surface.axis);
      condition["point"] = array_of(surface.point);
      condition["radius"] = surface.radius;
    }
    condition["wall"] = name_of(face.wall);
    condition["velocity"] = array_of(face.velocity);
    condition["angular_velocity"] = array_of(face.angular_velocity);
    condition["pivot"] = array_of(face.pivot);
    condition["may_bound_nothing"] = face.may_bound_nothing;
    faces[py::str(face.name)] = condition;
  }
  return faces;
}

py::object patch(py::object self, const std::string& name, py::object extent, const py::kwargs& keywords) {
  auto& container = self.cast<Container&>();
  const int face = face_of(container, name);
  const auto numbers = reals_of(extent, "patch");
  if (numbers.ndim() != 2 || numbers.shape(1) != 2)
    throw InputError("patch: give intervals [lower, upper], m: two of a rectangle, or three of a block of space");
  container.patches.push_back(patch_on(container, face, {numbers.data(), numbers.data() + numbers.size()},
                                       required_boundary("patch()", keywords)));
  return self;
}

// -------------------------------------------------------------------------------------- the class

const char* const container_text =
    R"(A closed convex container: planes at any angle, or a round cylinder between two planes square to its axis, m.

    cell = pfv.Container({"planes": [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0},
                                     {"name": "top", "inward_normal": [0, 0, -1], "offset": -0.2}],
                          "cylinders": [{"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0], "radius": 0.05}]})
    cell.face("bottom", pressure=5.0).face("top", pressure=0.0)

shape: a dict, or the path of a JSON file, as `pfv solve --container` takes it (doc/container.md): inside is where
    inward_normal . x >= offset for each plane and within each cylinder; a cylinder with "flats": N is N planes
wall: "no_slip" or "symmetry", of all sealed faces
periodic: axes along which the packing repeats, between two planes normal to them that are no walls then; all other faces
    are parallel to them: a cylinder or prism along its own axis
gradient: macroscopic pressure gradient along periodic axes, Pa/m, 3 numbers; fluid flows against it

A face that is not named is sealed and at rest. A Flow takes a copy: hand a changed container to `Flow.set_box`. Raises
InputError for one that is open or empty, for a face that bounds nothing, and naming entries that are wrong.)";

const std::string container_face_text = R"(Sets what is named of a face and returns the container.

)" + names_of_boundaries() + R"(, wall: as for `Box.face`
velocity: m/s, 3 numbers of its pivot, or one along a plane's inward normal: positive into the fluid
angular_velocity: rad/s, 3 numbers; pivot: the point that it turns about, m; spin: rad/s, a cylinder about its axis
may_bound_nothing: True where others may keep the fluid from it

Raises InputError for an unknown face, TypeError for an unknown keyword.)";

const char* const place_text = R"(Gives a face another place and returns the container: a plane inward_normal and offset or the
offset alone (m), a cylinder axis, point or radius (m). What is None stays. Whether the faces still close a room is
checked when a Flow takes them.)";

const std::string container_patch_text = R"(Gives a part of a face a boundary of its own and returns the container.

extent: [[x0, x1], [y0, y1], [z0, z1]], m, a block of space that cuts the part out of any face, or, on a plane normal
    to an axis, [[a0, a1], [b0, b1]] along the two other axes in the order x, y, z
one of )" + names_of_boundaries() + R"(: as for a face. Where patches overlap, the later one wins.)";

std::string names_text_of(const Container& container) {
  std::ostringstream text;
  text << "pfv.Container(";
  const char* between = "";
  for (const ContainerFace& face : container.faces) {
    text << between << face.name << (face.surface.is_plane() ? ": plane" : ": cylinder");
    between = ", ";
  }
  text << ')';
  return text.str();
}

void add_conditions_of(py::class_<Container>& container) {
  container.def("face", [](py::object self, const std::string& name, const py::kwargs& keywords) {
                  set_container_face(self.cast<Container&>(), name, keywords);
                  return self;
                }, "name"_a, container_face_text.c_str());
  container.def("place", &place, "name"_a, py::kw_only(), "inward_normal"_a = py::none(), "offset"_a = py::none(),
                "axis"_a = py::none(), "point"_a = py::none(), "radius"_a = py::none(), place_text);
  container.def("patch", &patch, "name"_a, "extent"_a, container_patch_text.c_str());
  container.def("region", &region_added<Container>, "lower"_a, "upper"_a, region_text.c_str());
}

/// Of its faces as they are now.
Container with_bounds(Container container) {
  find_bounds(container);
  return container;
}

void add_measures_of(py::class_<Container>& container) {
  container.def_property("gradient", [](const Container& self) { return array_of(self.pressure_gradient); },
                         [](Container& self, py::object slope) { self.pressure_gradient = vector_of(slope, "gradient"); },
                         "Macroscopic pressure gradient along periodic axes, Pa/m.");
  container.def_property_readonly("periodic", [](const Container& self) { return periodic_text(self.periodic); },
                                  "Axes along which the packing repeats: \"z\".");
  container.def_property_readonly("faces", &faces_and_places_of, "{name: {condition: value}} of all faces, with their places.");
  container.def_property_readonly("lower", [](const Container& self) { return array_of(with_bounds(self).lower); },
                                  "Lower corner of the smallest box around it, m: a copy.");
  container.def_property_readonly("upper", [](const Container& self) { return array_of(with_bounds(self).upper); },
                                  "Upper corner of the smallest box around it, m: a copy.");
  container.def_property_readonly("volume", [](const Container& self) { return volume_of(self); }, "m3");
  container.def("area", [](const Container& self, const std::string& name) {
                  return face_areas(self)[static_cast<std::size_t>(face_of(self, name))];
                }, "name"_a, "Area of a face, m2.");
  container.def("copy", [](const Container& self) { return self; }, "A container of its own.");
  container.def("__copy__", [](const Container& self) { return self; });
  container.def("__deepcopy__", [](const Container& self, py::object) { return self; });
  container.def("__repr__", &names_text_of);
}

}  // namespace

void add_container_class(py::module_& module) {
  py::class_<Container> container(module, "Container", container_text);
  container.def(py::init(&make_container), "shape"_a, py::kw_only(), "wall"_a = "no_slip", "periodic"_a = "",
                "gradient"_a = py::make_tuple(0.0, 0.0, 0.0));
  add_conditions_of(container);
  add_measures_of(container);
}

}  // namespace pfv::python
