// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_arguments.hpp"

#include "numbers.hpp"
#include "pfv/error.hpp"
#include "pfv/words.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <array>
#include <optional>
#include <set>
#include <string_view>

namespace pfv::app {
namespace {

/// "sealed, pressure=P, flux=Q"; those that are open alone: of a region.
std::string boundary_items(bool with_sealed = true) {
  return list_boundary_kinds([&](const BoundaryKind& one) {
    if (!with_sealed && !one.is_open()) return std::string();
    return one.name + (one.symbol ? std::string("=") + one.symbol : "");
  });
}

std::string face_items() { return boundary_items() + ", wall=" + names_of<Wall>("|") + ", velocity=V, spin=W"; }

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw InputError(where + ": " + what);
}

std::vector<std::string> parts(const std::string& text, char separator) {
  std::vector<std::string_view> views;
  detail::split(text, separator, views);
  return {views.begin(), views.end()};
}

/// KEY or KEY=VALUE.
struct Item {
  std::string key;
  std::optional<std::string> value;
};

Item item_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {text, std::nullopt};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

const std::string& value_of(const std::string& where, const Item& item) {
  if (!item.value) fail(where, item.key + " needs a value: write " + item.key + "=VALUE");
  return *item.value;
}

/// The boundary that an item names, or nothing when it is about something else.
std::optional<Boundary> boundary_of(const std::string& where, const Item& item) {
  for (const BoundaryKind& one : boundary_kinds) {
    if (item.key != one.name) continue;
    if (one.symbol) return Boundary{one.kind, number(where, value_of(where, item)), {}};
    if (item.value) fail(where, item.key + " takes no value: write " + item.key);
    return Boundary{one.kind, 0.0, {}};
  }
  return std::nullopt;
}

/// Collects the items of one face, which may come in several arguments.
class FaceItems {
 public:
  explicit FaceItems(ContainerFace& face) : face_(face) {}

  void take(const std::string& where, const Item& item) {
    if (const auto boundary = boundary_of(where, item)) {
      claim(where, "boundary", item);
      face_.boundary = *boundary;
    } else if (item.key == "wall") {
      claim(where, "wall", item);
      face_.wall = wall_named(where, value_of(where, item));
    } else if (item.key == "velocity") {
      claim(where, "velocity", item);
      if (!face_.surface.is_plane())
        fail(where, "a cylinder has no axis to move along: use spin=W (rad/s, about its axis)");
      face_.velocity = number(where, value_of(where, item)) * face_.guide;
    } else if (item.key == "spin") {
      claim(where, "spin", item);
      if (face_.surface.is_plane()) fail(where, "spin=W is for cylinders: use velocity=V");
      face_.angular_velocity = number(where, value_of(where, item)) * face_.surface.axis;
      face_.pivot = face_.surface.point;
    } else {
      fail(where, "unknown item " + detail::quoted(item.key) + ": use " + face_items());
    }
  }

 private:
  void claim(const std::string& where, const std::string& subject, const Item& item) {
    if (!claimed_.insert(subject).second)
      fail(where, item.key + " contradicts or repeats an earlier item of this face: give one " +
                      (subject == "boundary" ? "of " + boundary_items() : subject));
  }

  ContainerFace& face_;
  std::set<std::string> claimed_;
};

/// Number of the face that is named.
int face_of(const std::string& where, const std::string& name, const Container& container) {
  if (const std::optional<int> face = container.face_named(name)) return *face;
  std::string names;
  for (const ContainerFace& face : container.faces) names += (names.empty() ? "" : ", ") + face.name;
  fail(where, "unknown face " + detail::quoted(name) + ": use " + names);
}

Boundary required_boundary(const std::string& where, const std::string& item, const std::string& items) {
  const auto boundary = boundary_of(where, item_of(item));
  if (!boundary) fail(where, "unknown item " + detail::quoted(item) + ": use " + items);
  return *boundary;
}

ContainerPatch patch_of(const std::string& argument, const Container& container) {
  const std::string where = "--patch " + detail::quoted(argument);
  const std::vector<std::string> fields = parts(argument, ':');
  if (fields.size() != 3) fail(where, "write NAME:A0,A1,B0,B1:ITEM or NAME:X0,X1,Y0,Y1,Z0,Z1:ITEM");
  const std::vector<std::string> texts = parts(fields[1], ',');
  const int face = face_of(where, fields[0], container);
  std::vector<double> bounds;
  for (const std::string& text : texts) bounds.push_back(number(where, text));
  return patch_on(container, face, bounds, required_boundary(where, fields[2], boundary_items()));
}

/// `form`: how the argument is written, with as many names of numbers as `count`.
std::vector<double> numbers_of(const std::string& where, const std::vector<std::string>& fields,
                               std::size_t count, const char* form) {
  const std::vector<std::string> texts =
      fields.size() == 2 ? parts(fields[0], ',') : std::vector<std::string>{};
  if (texts.size() != count) fail(where, std::string("write ") + form);
  std::vector<double> numbers;
  for (const std::string& text : texts) numbers.push_back(number(where, text));
  return numbers;
}

Region region_of(const std::string& argument) {
  const std::string where = "--region " + detail::quoted(argument);
  const std::vector<std::string> fields = parts(argument, ':');
  const auto n = numbers_of(where, fields, 6, "X0,X1,Y0,Y1,Z0,Z1:ITEM");
  return {{n[0], n[2], n[4]},
          {n[1], n[3], n[5]},
          required_boundary(where, fields[1], boundary_items(false))};
}

Region point_of(const std::string& argument) {
  const std::string where = "--point " + detail::quoted(argument);
  const std::vector<std::string> fields = parts(argument, ':');
  const auto n = numbers_of(where, fields, 3, "X,Y,Z:ITEM");
  const Eigen::Vector3d place(n[0], n[1], n[2]);
  return {place, place, required_boundary(where, fields[1], boundary_items(false))};
}

}  // namespace

Wall wall_named(const std::string& option, const std::string& name) {
  return Words({name}, option).choice<Wall>();
}

void apply_faces(const std::vector<std::string>& arguments, Wall wall, Container& container) {
  std::vector<FaceItems> faces;
  for (ContainerFace& face : container.faces) {
    face.wall = wall;
    faces.emplace_back(face);
  }
  for (const std::string& argument : arguments) {
    const std::string where = "--face " + detail::quoted(argument);
    const std::size_t colon = argument.find(':');
    if (colon == std::string::npos)
      fail(where, std::string("no items: write NAME:ITEM[,ITEM]... with items ") + face_items());
    const int face = face_of(where, argument.substr(0, colon), container);
    for (const std::string& item : parts(argument.substr(colon + 1), ','))
      faces[face].take(where, item_of(item));
  }
}

void apply_patches(const std::vector<std::string>& arguments, Container& container) {
  for (const std::string& argument : arguments) container.patches.push_back(patch_of(argument, container));
}

void apply_regions(const std::vector<std::string>& regions, const std::vector<std::string>& points,
                   Container& container) {
  for (const std::string& argument : regions) container.regions.push_back(region_of(argument));
  for (const std::string& argument : points) container.regions.push_back(point_of(argument));
}

}  // namespace pfv::app
