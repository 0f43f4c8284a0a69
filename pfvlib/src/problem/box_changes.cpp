// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/box_changes.hpp"

#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

bool same_kinds(const Container& a, const Container& b) {
  if (a.patches.size() != b.patches.size() || a.regions.size() != b.regions.size() ||
      a.periodic != b.periodic || a.tilt != b.tilt || a.is_box != b.is_box || a.faces.size() != b.faces.size())
    return false;
  for (std::size_t i = 0; i < a.regions.size(); ++i)
    if (a.regions[i].lower != b.regions[i].lower || a.regions[i].upper != b.regions[i].upper ||
        a.regions[i].boundary.kind != b.regions[i].boundary.kind)
      return false;
  for (std::size_t i = 0; i < a.patches.size(); ++i)
    if (a.patches[i].face != b.patches[i].face ||
        a.patches[i].lower != b.patches[i].lower || a.patches[i].upper != b.patches[i].upper ||
        a.patches[i].boundary.kind != b.patches[i].boundary.kind)
      return false;
  for (int f = 0; f < a.face_count(); ++f)
    if (a.faces[f].surface.kind != b.faces[f].surface.kind || a.faces[f].wall != b.faces[f].wall ||
        a.faces[f].boundary.kind != b.faces[f].boundary.kind)
      return false;
  return true;
}

bool same_surfaces(const Container& a, const Container& b) {
  const auto same = [](const ContainerFace& one, const ContainerFace& other) {
    const Surface &s = one.surface, &t = other.surface;
    return s.kind == t.kind && s.normal == t.normal && s.offset == t.offset && s.axis == t.axis &&
           s.point == t.point && s.radius == t.radius;
  };
  return std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), same);
}

bool same_shape(const Container& a, const Container& b) {
  return a.is_box == b.is_box && a.lower == b.lower && a.upper == b.upper && same_surfaces(a, b);
}

void require_time_step(double dt, bool commit) {
  const bool fits = std::isfinite(dt) && (commit ? dt > 0.0 : dt >= 0.0);
  if (!fits)
    throw InputError("the time step is " + detail::number_text(dt) + " s; it must be " +
                     (commit ? ">" : ">=") + " 0 and finite");
}

}  // namespace pfv
