// SPDX-License-Identifier: GPL-3.0-or-later
// Walls beside periodic sides: those of a box that is empty along its periodic axes, or a pipe, which is closed by the ends of
// a period.
#include "found_walls.h"

#include "wall_places.h"

#include "pfv/container.hpp"
#include "pfv/error.hpp"

#include "domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace LAMMPS_NS {

namespace {

using Source = PfvFaceSource::Kind;

/// Of a box with periodic axes the face that a plane is: normal to another axis, with the fluid on its inner side.
std::optional<std::size_t> face_of_cell(const std::vector<pfv::Surface>& surfaces, const PfvSettings& settings,
                                        const Eigen::Vector3d& middle) {
  if (surfaces.size() != 1 || !surfaces[0].is_plane()) return {};
  const Eigen::Vector3d normal = facing(surfaces[0], middle).normal;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!settings.box.periodic[axis] && std::abs(normal[static_cast<Eigen::Index>(axis)]) > 1.0 - same)
      return 2 * axis + (normal[static_cast<Eigen::Index>(axis)] > 0.0 ? 1 : 0);
  return {};
}

/// The faces of a box that the cell is, empty along its periodic axes.
void become_box(PfvSettings& settings, const std::array<std::optional<std::size_t>, pfv::face_count>& chosen) {
  const PfvSettings before = settings;
  settings.container = false;
  settings.faces.clear();
  settings.sources.assign(pfv::face_count, {});
  for (PfvBinding& binding : settings.bindings)
    for (std::size_t face = 0; binding.of == PfvBinding::Of::face && face < chosen.size(); ++face)
      if (chosen[face] == before.bindings[static_cast<std::size_t>(&binding - settings.bindings.data())].number)
        binding.number = face;
  for (std::size_t face = 0; face < chosen.size(); ++face) {
    PfvFaceSource& source = settings.sources[face];
    if (!chosen[face]) {
      source.kind = Source::periodic;
      continue;
    }
    source = before.sources[*chosen[face]];
    const auto axis = static_cast<Eigen::Index>(face / 2);
    if (source.kind == Source::plane) source.plane = source.surface.offset * source.surface.normal[axis];
    settings.box.faces[face].wall = before.faces[*chosen[face]].wall;
    settings.box.faces[face].boundary = before.faces[*chosen[face]].boundary;
  }
}

/// A periodic axis that one of the walls is not parallel to.
std::optional<int> axis_across(const std::vector<pfv::Surface>& surfaces, const PfvSettings& settings) {
  for (const pfv::Surface& surface : surfaces)
    for (int axis = 0; axis < 3; ++axis) {
      const bool parallel = surface.is_plane() ? std::abs(surface.normal[axis]) < same
                                               : std::abs(surface.axis[axis]) > 1.0 - same;
      if (settings.box.periodic[axis] && !parallel) return axis;
    }
  return {};
}

std::string no_wall_on(pfv::Face face, const std::vector<std::string>& left_out) {
  std::string text = std::string("container walls: no wall bounds the periodic cell on its side ") + pfv::name_of(face) +
                     "; give it a face there: `face NAME plane X Y Z NX NY NZ` or `face NAME extent AXIS lo` or `hi`";
  for (const std::string& reason : left_out) text += "; left out: " + reason;
  return text;
}

}  // namespace

/// Walls across a periodic axis: one that the words name is refused, another left out.
void PfvFoundWalls::leave_out_walls_across(PfvSettings& settings, std::vector<Surfaces>& surfaces, std::size_t named,
                                           std::vector<std::string>& left_out) const {
  for (std::size_t f = settings.faces.size(); f-- > 0;) {
    const std::optional<int> axis = axis_across(surfaces[f], settings);
    if (!axis) continue;
    const std::string what = "face " + settings.faces[f].name, where = std::string(1, "xyz"[*axis]);
    if (f < named)
      throw pfv::InputError(what + ": it stands across " + where + ", along which the simulation box is periodic; take it "
                            "out, or use `boundary f` along that axis");
    left_out.push_back(what + " stands across " + where + ", along which the simulation box is periodic");
    remove_wall(settings, surfaces, f);
  }
}

/// Whether all walls are faces of a box, the ends of periods aside.
bool PfvFoundWalls::is_cell(const PfvSettings& settings, const std::vector<Surfaces>& surfaces) const {
  const Eigen::Vector3d middle = middle_of_grains();
  for (std::size_t f = 0; f < surfaces.size(); ++f)
    if (settings.sources[f].kind != Source::periodic && !face_of_cell(surfaces[f], settings, middle)) return false;
  return true;
}

/// Two more faces along each periodic axis, which are no walls.
void PfvFoundWalls::add_periods(PfvSettings& settings, std::vector<Surfaces>& surfaces) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (!settings.box.periodic[axis]) continue;
    for (const bool upper : {false, true}) {
      PfvFaceSource source;
      source.kind = Source::periodic;
      source.surface = pfv::Surface::plane((upper ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis),
                                           (upper ? domain->boxhi : domain->boxlo)[axis] * Eigen::Vector3d::Unit(axis));
      pfv::ContainerFace face;
      face.name = std::string("period_") + "xyz"[axis] + (upper ? "hi" : "lo");
      settings.faces.push_back(face);
      settings.sources.push_back(source);
      surfaces.push_back({source.surface});
    }
  }
}

void PfvFoundWalls::remove_periods(PfvSettings& settings, std::vector<Surfaces>& surfaces) const {
  for (std::size_t f = settings.faces.size(); f-- > 0;) {
    if (settings.sources[f].kind == Source::periodic) remove_wall(settings, surfaces, f);
  }
}

/// Of walls that are faces of a box: two along each axis that is not periodic.
void PfvFoundWalls::make_cell(PfvSettings& settings, const std::vector<Surfaces>& surfaces, std::size_t named,
                              std::vector<std::string>& left_out) const {
  const Eigen::Vector3d middle = middle_of_grains();
  std::array<std::optional<std::size_t>, pfv::face_count> chosen;
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    const std::string what = "face " + settings.faces[f].name;
    const std::optional<std::size_t> face = face_of_cell(surfaces[f], settings, middle);
    if (is_behind_another(f, surfaces[f][0], settings, surfaces, middle)) {
      left_out.push_back("wall '" + settings.faces[f].name + "' bounds nothing, since others keep the fluid from it");
      continue;
    }
    if (chosen[*face] && f < named)
      throw pfv::InputError(what + " and face " + settings.faces[*chosen[*face]].name + " are on one side; take one out");
    if (!chosen[*face]) chosen[*face] = f;
  }
  for (const pfv::Face face : pfv::all_faces)
    if (const auto number = static_cast<std::size_t>(face); !settings.box.periodic[number / 2] && !chosen[number])
      throw pfv::InputError(no_wall_on(face, left_out));
  become_box(settings, chosen);
}

}  // namespace LAMMPS_NS
