// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/pi.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

namespace pfv {

namespace {

using InputJson = nlohmann::json;

[[noreturn]] void fail(const std::string& where, const std::string& what) { throw InputError(where + ": " + what); }

/// The entry of that name, which must be there.
const InputJson& entry(const std::string& where, const InputJson& object, const std::string& name) {
  const auto found = object.find(name);
  if (found == object.end()) fail(where, "it has no \"" + name + "\"");
  return *found;
}

double number_of(const std::string& where, const InputJson& object, const std::string& name) {
  const InputJson& value = entry(where, object, name);
  if (!value.is_number()) fail(where, "\"" + name + "\" is no number");
  return value.get<double>();
}

Eigen::Vector3d vector_of(const std::string& where, const InputJson& object, const std::string& name) {
  const InputJson& value = entry(where, object, name);
  const bool three = value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() &&
                     value[2].is_number();
  if (!three) fail(where, "\"" + name + "\" is no list of three numbers");
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

Eigen::Vector3d direction_of(const std::string& where, const InputJson& object, const std::string& name) {
  const Eigen::Vector3d direction = vector_of(where, object, name);
  if (!(direction.norm() > 0.0)) fail(where, "\"" + name + "\" has no length");
  return direction;
}

void refuse_unknown(const std::string& where, const InputJson& object, const std::set<std::string>& known) {
  if (!object.is_object()) fail(where, "it is no object {...}");
  for (const auto& item : object.items())
    if (known.count(item.key()) == 0) {
      std::string names;
      for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
      fail(where, "unknown entry \"" + item.key() + "\": use " + names);
    }
}

ContainerFace named_face(const std::string& where, const InputJson& object) {
  const InputJson& name = entry(where, object, "name");
  if (!name.is_string() || name.get<std::string>().empty()) fail(where, "its \"name\" is no text");
  ContainerFace face;
  face.name = name.get<std::string>();
  return face;
}

std::vector<ContainerFace> read_plane(const std::string& where, const InputJson& object) {
  refuse_unknown(where, object, {"name", "inward_normal", "offset"});
  ContainerFace face = named_face(where, object);
  const Eigen::Vector3d inward = direction_of(where, object, "inward_normal");
  const double length = inward.norm(), offset = number_of(where, object, "offset");
  face.surface.normal = -inward / length;
  face.surface.offset = -offset / length;
  face.guide = inward / length;
  return {face};
}

/// So many planes around, of the cylinder's section: shell_1, shell_2, ...
std::vector<ContainerFace> flats_of(const std::string& where, const ContainerFace& round, const InputJson& count) {
  constexpr int fewest = 3, most = most_faces - 2;  // and two ends
  const std::int64_t number = count.is_number_integer() ? count.get<std::int64_t>() : 0;
  if (number < fewest || number > most)
    fail(where, "\"flats\" is no whole number from " + std::to_string(fewest) + " to " + std::to_string(most));
  if (!(round.surface.radius > 0.0)) fail(where, "\"radius\" is not positive");
  const int flats = static_cast<int>(number);
  const Surface& shell = round.surface;
  const double half = pi / flats, apothem = shell.radius * std::sqrt(half / std::tan(half));
  const Eigen::Vector3d first = shell.axis.unitOrthogonal(), second = shell.axis.cross(first);
  std::vector<ContainerFace> faces;
  for (int i = 0; i < flats; ++i) {
    const double angle = (2 * i + 1) * half;
    const Eigen::Vector3d outward = std::cos(angle) * first + std::sin(angle) * second;
    ContainerFace face;
    face.name = round.name + "_" + std::to_string(i + 1);
    face.surface = Surface::plane(outward, shell.point + apothem * outward);
    face.guide = -face.surface.normal;
    faces.push_back(face);
  }
  return faces;
}

std::vector<ContainerFace> read_cylinder(const std::string& where, const InputJson& object) {
  refuse_unknown(where, object, {"name", "axis", "point", "radius", "flats"});
  ContainerFace face = named_face(where, object);
  face.surface = Surface::cylinder(direction_of(where, object, "axis"), vector_of(where, object, "point"),
                                   number_of(where, object, "radius"));
  const auto flats = object.find("flats");
  return flats == object.end() ? std::vector<ContainerFace>{face} : flats_of(where, face, *flats);
}

template <class Make>
void add_faces(std::vector<ContainerFace>& faces, const std::string& path, const InputJson& json, const char* kind,
               Make&& make) {
  const auto list = json.find(kind);
  if (list == json.end()) return;
  if (!list->is_array()) fail(path, std::string("\"") + kind + "\" is no list");
  for (std::size_t i = 0; i < list->size(); ++i)
    for (ContainerFace& face : make(path + ", " + kind + " " + std::to_string(i + 1), (*list)[i]))
      faces.push_back(std::move(face));
}

}  // namespace

Container read_container(const std::string& path) {
  std::ifstream file(path);
  if (!file) fail(path, "cannot be read: give the name of a file that holds a container");
  return container_of_json({std::istreambuf_iterator<char>(file), {}}, path);
}

Container container_of_json(const std::string& text, const std::string& where) {
  InputJson json;
  try {
    json = InputJson::parse(text);
  } catch (const InputJson::exception& error) {
    fail(where, std::string("it is no JSON: ") + error.what());
  }
  refuse_unknown(where, json, {"planes", "cylinders"});
  std::vector<ContainerFace> faces;
  add_faces(faces, where, json, "planes", read_plane);
  add_faces(faces, where, json, "cylinders", read_cylinder);
  if (faces.empty()) fail(where, "it has neither planes nor cylinders");
  return container_of(std::move(faces));
}

}  // namespace pfv
