// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_places.h"

#include "pfv/error.hpp"

#include <cmath>
#include <string>

namespace LAMMPS_NS {

bool same_plane(const pfv::Surface& a, const pfv::Surface& b, double nothing) {
  if (!a.is_plane() || !b.is_plane()) return false;
  const double way = a.normal.dot(b.normal) > 0.0 ? 1.0 : -1.0;
  return (a.normal - way * b.normal).norm() < same && std::abs(a.offset - way * b.offset) < same * std::abs(a.offset) + nothing;
}

pfv::Surface facing(const pfv::Surface& surface, const Eigen::Vector3d& inside) {
  if (!surface.is_plane() || surface.distance(inside) >= 0.0) return surface;
  return pfv::Surface::plane(-surface.normal, surface.offset * surface.normal);
}

bool is_behind_another(std::size_t face, const pfv::Surface& plane, const PfvSettings& settings,
                       const std::vector<std::vector<pfv::Surface>>& surfaces, const Eigen::Vector3d& middle) {
  if (!plane.is_plane() || settings.sources[face].kind == PfvFaceSource::Kind::extent) return false;
  const pfv::Surface far = facing(plane, middle);
  for (std::size_t other = 0; other < surfaces.size(); ++other) {
    if (other == face || surfaces[other].size() != 1 || !surfaces[other][0].is_plane()) continue;
    const bool extreme = settings.sources[other].kind == PfvFaceSource::Kind::extent;
    const pfv::Surface near = extreme ? surfaces[other][0] : facing(surfaces[other][0], middle);
    if ((far.normal - near.normal).norm() < same && (extreme || far.distance(middle) > near.distance(middle))) return true;
  }
  return false;
}

void remove_wall(PfvSettings& settings, std::vector<std::vector<pfv::Surface>>& surfaces, std::size_t face) {
  const auto at = static_cast<std::ptrdiff_t>(face);
  settings.faces.erase(settings.faces.begin() + at);
  settings.sources.erase(settings.sources.begin() + at);
  surfaces.erase(surfaces.begin() + at);
}

std::optional<double> volume_within(const std::vector<std::vector<pfv::Surface>>& of_faces, const Eigen::Vector3d& middle) {
  std::vector<pfv::ContainerFace> faces;
  for (const auto& surfaces : of_faces)
    for (const pfv::Surface& surface : surfaces) {
      faces.emplace_back();
      faces.back().name = std::to_string(faces.size());
      faces.back().surface = facing(surface, middle);
      faces.back().may_bound_nothing = true;
    }
  try {
    return pfv::volume_of(pfv::container_of(faces));
  } catch (const pfv::InputError&) {
    return {};
  }
}

}  // namespace LAMMPS_NS
