// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/box.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <cmath>
#include <cstddef>
#include <string>

namespace pfv {
namespace {

using detail::number_text;

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

void require_finite(double value, const std::string& what) {
  if (!std::isfinite(value))
    throw InputError(what + " is " + number_text(value) + ": give a finite number");
}

/// Its powers, up to the tenth, are numbers.
void require_size(double length, const std::string& what) {
  constexpr double largest = 1e30, smallest = 1e-30;
  if (!(length >= smallest && length <= largest))
    throw InputError(what + " is " + number_text(length) + " m: give one between 1e-30 and 1e30 m");
}

std::string interval(double lower, double upper) {
  return "[" + number_text(lower) + ", " + number_text(upper) + "]";
}

void check_edge(const Box& box, int axis) {
  const double lower = box.lower[axis], upper = box.upper[axis];
  const std::string where = std::string("box along ") + axis_names[axis];
  require_finite(lower, where + ": lower bound");
  require_finite(upper, where + ": upper bound");
  require_finite(upper - lower, where + ": length");
  if (upper <= lower)
    throw InputError(where + " is " + interval(lower, upper) +
                     ", flat or inverted: give the lower bound first");
  require_size(upper - lower, where + ": length");
}

// A rectangle may reach beyond its face, since faces move: the part on the face counts.
void check_extent(const Box& box, const Patch& patch, int axis, int first,
                  const std::string& where) {
  const double from = patch.rectangle[first], to = patch.rectangle[first + 1];
  const std::string along = where + " along " + axis_names[axis];
  require_finite(from, along + ": lower bound");
  require_finite(to, along + ": upper bound");
  if (to <= from)
    throw InputError(along + " is " + interval(from, to) +
                     ", flat or inverted: give the lower bound first");
  if (to <= box.lower[axis] || from >= box.upper[axis])
    throw InputError(along + " is " + interval(from, to) + ", outside its face " +
                     interval(box.lower[axis], box.upper[axis]) + ": move it onto the face");
}

void check_tilt(const Box& box) {
  constexpr std::array<std::array<int, 2>, 3> axes{{{0, 1}, {0, 2}, {1, 2}}};
  for (int k = 0; k < 3; ++k) {
    const auto [along, of] = axes[k];
    const std::string where = std::string("tilt ") + axis_names[along] + axis_names[of];
    require_finite(box.tilt[k], where);
    if (box.tilt[k] != 0.0 && !(box.periodic[along] && box.periodic[of]))
      throw InputError(where + " needs periodic axes " + axis_names[along] + " and " + axis_names[of] +
                       ": make them periodic, or leave the tilt at 0");
  }
  for (const Face face : all_faces)
    if (box.is_tilted() && box.periodic[axis_of(face)] && box[face].velocity != 0.0)
      throw InputError(std::string("face ") + name_of(face) + ": a tilted cell cannot be stretched; leave its velocity at 0");
}

void check_periodic(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string where = std::string("pressure gradient along ") + axis_names[axis];
    require_finite(box.pressure_gradient[axis], where);
    if (!box.periodic[axis] && box.pressure_gradient[axis] != 0.0)
      throw InputError(where + ": that axis is not periodic; make it periodic, or give its faces "
                               "pressures");
  }
  for (const Face face : all_faces)
    if (box.periodic[axis_of(face)] &&
        (box[face].boundary.is_open() || !box[face].sliding.isZero(0.0) || box[face].spin != 0.0))
      throw InputError(std::string("face ") + name_of(face) +
                       " stands on a periodic axis: it can have neither a boundary nor a motion in its own plane; "
                       "its velocity stretches the cell");
  for (const Patch& patch : box.patches)
    if (box.periodic[axis_of(patch.face)])
      throw InputError(std::string("a patch on face ") + name_of(patch.face) +
                       " stands on a periodic axis: remove it");
}

void check_patch(const Box& box, std::size_t number) {
  const Patch& patch = box.patches[number];
  const std::string where =
      "patch " + std::to_string(number + 1) + " on face " + name_of(patch.face);
  const int axis = axis_of(patch.face);
  check_extent(box, patch, axis == 0 ? 1 : 0, 0, where);
  check_extent(box, patch, axis == 2 ? 1 : 2, 2, where);
  check(patch.boundary, where);
}

void check_region(const Box& box, std::size_t number) {
  const Region& region = box.regions[number];
  const std::string where = "region " + std::to_string(number + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = region.lower[axis], to = region.upper[axis];
    const std::string along = where + " along " + axis_names[axis];
    require_finite(from, along + ": lower bound");
    require_finite(to, along + ": upper bound");
    if (to < from)
      throw InputError(along + " is " + interval(from, to) +
                       ", inverted: give the lower bound first");
    if (to < box.lower[axis] || from > box.upper[axis])
      throw InputError(along + " is " + interval(from, to) + ", outside the box " +
                       interval(box.lower[axis], box.upper[axis]) + ": move it into the box");
  }
  if (!region.boundary.is_open())
    throw InputError(where + " has no boundary: give it one of " + list_boundary_kinds([](const BoundaryKind& one) {
                       return std::string(one.is_open() ? one.name : "");
                     }));
  check(region.boundary, where);
}

}  // namespace

std::string list_boundary_kinds(const std::function<std::string(const BoundaryKind&)>& form, const char* separator) {
  std::string list;
  for (const BoundaryKind& one : boundary_kinds)
    if (const std::string text = form(one); !text.empty()) list += (list.empty() ? "" : separator) + text;
  return list;
}

std::string names_of_boundaries() {
  return list_boundary_kinds([](const BoundaryKind& one) { return std::string(one.name); });
}

void check(const Boundary& boundary, const std::string& where) {
  for (const BoundaryKind& one : boundary_kinds) {
    if (one.kind != boundary.kind) continue;
    if (one.symbol) require_finite(boundary.value, where + ": " + one.name);
    return;
  }
  throw InputError(where + ": unknown kind of boundary: use one of " + names_of_boundaries());
}

void check(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) check_edge(box, axis);
  for (const Face face : all_faces) {
    const std::string where = std::string("face ") + name_of(face);
    require_finite(box[face].velocity, where + ": velocity");
    require_finite(box[face].spin, where + ": spin");
    if (!box[face].sliding.allFinite() || !box[face].pivot.allFinite() ||
        box[face].sliding[axis_of(face)] != 0.0)
      throw InputError(where + ": its sliding velocity and pivot must be finite, and the sliding velocity "
                       "has no part along the face's axis; that is `velocity`");
    check(box[face].boundary, where);
  }
  for (std::size_t number = 0; number < box.patches.size(); ++number) check_patch(box, number);
  for (std::size_t number = 0; number < box.regions.size(); ++number) check_region(box, number);
  check_periodic(box);
  check_tilt(box);
}

}  // namespace pfv
