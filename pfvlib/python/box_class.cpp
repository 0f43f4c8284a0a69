// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Box
#include "arrays.hpp"
#include "classes.hpp"
#include "conditions.hpp"
#include "faces.hpp"
#include "keywords.hpp"

#include "pfv/words.hpp"

#include <pybind11/stl.h>

namespace pfv::python {
namespace {

// ------------------------------------------------------------------------------------------ faces

const std::vector<std::string> conditions{"wall", "velocity", "sliding", "spin", "pivot"};

/// Only what is named changes.
void set_face(Box& box, const std::string& name, const py::kwargs& keywords) {
  FaceCondition face = condition_of(box, name);
  require_conditions(keywords, conditions);
  if (const auto boundary = boundary_among("face()", keywords)) face.boundary = *boundary;
  const auto given = [&](const char* key) { return keywords.contains(key); };
  if (given("wall")) face.wall = named<Wall>(py::str(keywords["wall"]));
  if (given("velocity")) face.velocity = number_of(keywords["velocity"], "velocity");
  if (given("spin")) face.spin = number_of(keywords["spin"], "spin");
  if (given("sliding")) face.sliding = vector_of(keywords["sliding"], "sliding");
  if (given("pivot")) face.pivot = vector_of(keywords["pivot"], "pivot");
  condition_of(box, name) = face;
}

py::dict faces_of(Box& box) {
  py::dict faces;
  for (const std::string& name : face_names(box)) {
    const FaceCondition& face = condition_of(box, name);
    py::dict condition = dict_of(face.boundary);
    condition["wall"] = name_of(face.wall);
    condition["velocity"] = face.velocity;
    condition["sliding"] = array_of(face.sliding);
    condition["spin"] = face.spin;
    condition["pivot"] = array_of(face.pivot);
    faces[py::str(name)] = condition;
  }
  return faces;
}

void add_patch(Box& box, const std::string& name, py::handle rectangle, const py::kwargs& keywords) {
  const auto [a, b] = [&] {
    const auto sides = intervals_of(rectangle, "patch", 2);
    return std::pair(sides[0], sides[1]);
  }();
  box.patches.push_back(patch_of(box, name, {a[0], a[1], b[0], b[1]}, required_boundary("patch()", keywords)));
}

// -------------------------------------------------------------------------------------- classes

const char* const box_text =
    R"(A flow box: plane walls normal to the axes, m.

    box = pfv.Box([[0, 1], [0, 1], [0, 2]], wall="symmetry")
    box.face("zlo", pressure=5.0).face("zhi", pressure=0.0, velocity=-0.01)

bounds: [[xlo, xhi], [ylo, yhi], [zlo, zhi]], m
wall: "no_slip" or "symmetry", of all sealed faces
periodic: axes along which the packing repeats, "xy" for instance; their faces do not exist
gradient: macroscopic pressure gradient along periodic axes, Pa/m, 3 numbers; fluid flows against it
tilt: how far the cell leans, m: xy, the way of its upper y side along x, then xz and yz (LIGGGHTS' triclinic box);
    both axes of a component must be periodic. Spheres may stand anywhere on the lattice

Faces are xlo, xhi, ylo, yhi, zlo, zhi; one that is not named is sealed and at rest. A Flow takes a copy: hand a
changed box to `Flow.set_box`. Raises InputError for bounds that are flat, inverted or not finite, and for a tilt along
an axis that is not periodic.)";

const std::string face_text = R"(Sets what is named of a face and returns the box.

)" + boundary_lines() + R"(
wall: "no_slip" or "symmetry"
velocity: m/s along the face's axis, positive along +axis
sliding: m/s, 3 numbers in the face's plane; spin: rad/s about its axis; pivot: a point of that axis, m

Raises InputError for an unknown face, TypeError for an unknown keyword.)";

const std::string patch_text =
    R"(Adds a rectangle with a boundary of its own to a face and returns the box.

rectangle: [[a0, a1], [b0, b1]], m, along the two other axes in the order x, y, z
one of )" + names_of_boundaries() + R"(: as for a face. Where patches overlap, the later one wins.)";

std::string text_of(const Box& box) {
  std::ostringstream text;
  text << "pfv.Box([";
  for (int axis = 0; axis < 3; ++axis)
    text << (axis ? ", " : "") << '[' << box.lower[axis] << ", " << box.upper[axis] << ']';
  text << ']';
  if (box.any_periodic()) text << ", periodic='" << periodic_text(box.periodic) << '\'';
  if (box.is_tilted()) text << ", tilt=(" << box.tilt[0] << ", " << box.tilt[1] << ", " << box.tilt[2] << ')';
  text << ')';
  return text.str();
}

void add_conditions(py::class_<Box>& box) {
  using namespace py::literals;
  box.def("face", [](py::object self, const std::string& name, const py::kwargs& keywords) {
            set_face(self.cast<Box&>(), name, keywords);
            return self;
          }, "name"_a, face_text.c_str());
  box.def("patch", [](py::object self, const std::string& name, py::object rectangle, const py::kwargs& keywords) {
            add_patch(self.cast<Box&>(), name, rectangle, keywords);
            return self;
          }, "name"_a, "rectangle"_a, patch_text.c_str());
  box.def("region", &region_added<Box>, "lower"_a, "upper"_a, region_text.c_str());
}

void add_measures(py::class_<Box>& box) {
  using namespace py::literals;
  box.def_property("lower", [](const Box& self) { return array_of(self.lower); },
                   [](Box& self, py::object corner) { self.lower = vector_of(corner, "lower"); },
                   "Lower corner, m: a copy; assign to move it.");
  box.def_property("upper", [](const Box& self) { return array_of(self.upper); },
                   [](Box& self, py::object corner) { self.upper = vector_of(corner, "upper"); },
                   "Upper corner, m: a copy; assign to move it.");
  box.def_property("gradient", [](const Box& self) { return array_of(self.pressure_gradient); },
                   [](Box& self, py::object slope) { self.pressure_gradient = vector_of(slope, "gradient"); },
                   "Macroscopic pressure gradient along periodic axes, Pa/m.");
  box.def_property("tilt", [](const Box& self) { return array_of(self.tilt); },
                   [](Box& self, py::object components) { self.tilt = vector_of(components, "tilt"); },
                   "How far the cell leans, m: xy, xz, yz; a copy; assign to change it.");
  box.def_property_readonly("periodic", [](const Box& self) { return periodic_text(self.periodic); }, "Axes along which the packing repeats: \"xy\".");
  box.def_property_readonly("faces", &faces_of, "{name: {condition: value}} of all faces.");
  box.def_property_readonly("volume", &Box::volume, "m3");
  box.def("position", &position_of, "name"_a, "Place of a face on its axis, m.");
  box.def("area", &area_of, "name"_a, "Area of a face, m2.");
  box.def("copy", [](const Box& self) { return self; }, "A box of its own.");
  box.def("__copy__", [](const Box& self) { return self; });
  box.def("__deepcopy__", [](const Box& self, py::object) { return self; });
  box.def("__repr__", &text_of);
}

}  // namespace

Box make_box(py::handle bounds, const std::string& wall, py::handle periodic) {
  Box box;
  const auto intervals = intervals_of(bounds, "box", 3);
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = intervals[static_cast<std::size_t>(axis)][0];
    box.upper[axis] = intervals[static_cast<std::size_t>(axis)][1];
  }
  box.periodic = periodic_of(periodic);
  for (const std::string& name : face_names(box)) condition_of(box, name).wall = named<Wall>(wall);
  check(box);
  return box;
}

Container container_of(py::handle given) {
  if (py::isinstance<Container>(given)) return given.cast<Container>();
  if (py::isinstance<Box>(given)) return given.cast<Box>();
  return make_box(given, name_of(Wall::no_slip), py::str(""));
}

void add_box_class(py::module_& module) {
  using namespace py::literals;
  py::class_<Box> box(module, "Box", box_text);
  const auto made = [](py::object bounds, const std::string& wall, py::object periodic, py::object gradient,
                       py::object tilt) {
    Box given = make_box(bounds, wall, periodic);
    given.pressure_gradient = vector_of(gradient, "gradient");
    given.tilt = vector_of(tilt, "tilt");
    check(given);
    return given;
  };
  box.def(py::init(made), "bounds"_a, py::kw_only(), "wall"_a = "no_slip", "periodic"_a = "",
          "gradient"_a = py::make_tuple(0.0, 0.0, 0.0), "tilt"_a = py::make_tuple(0.0, 0.0, 0.0));
  add_conditions(box);
  add_measures(box);
}

}  // namespace pfv::python
