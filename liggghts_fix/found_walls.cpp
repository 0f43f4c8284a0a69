// SPDX-License-Identifier: GPL-3.0-or-later
#include "found_walls.h"

#include "script_units.h"
#include "wall_places.h"
#include "wall_shapes.h"

#include "pfv/container.hpp"
#include "pfv/error.hpp"

#include "atom.h"
#include "domain.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "modify.h"
#include "update.h"

#include <mpi.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace LAMMPS_NS {

namespace {

using Source = PfvFaceSource::Kind;

/// With more of the grains than this on its far side a wall stands among them.
constexpr double among_grains = 0.01;
/// Grains whose middle is further from a cylinder's axis, as a part of its radius, fill it half or less: pores would
/// reach around the axis.
constexpr double aside = 0.4;

bool is_obstacle(const PfvSettings& settings, const std::string& id) {
  return std::any_of(settings.obstacles.begin(), settings.obstacles.end(),
                     [&](const PfvObstacleSource& obstacle) { return obstacle.fix_id == id; });
}

/// A face already, or none since it stands inside.
bool is_source(const PfvSettings& settings, const std::string& id) {
  return is_obstacle(settings, id) ||
         std::any_of(settings.sources.begin(), settings.sources.end(), [&](const PfvFaceSource& source) {
           return (source.kind == Source::wall || source.kind == Source::mesh) && source.fix_id == id;
         });
}

PfvFaceSource source_of(const PfvWall& wall) {
  PfvFaceSource source;
  source.kind = wall.mesh ? Source::mesh : Source::wall;
  source.fix_id = wall.id;
  return source;
}

bool any_cylinder(const std::vector<std::vector<pfv::Surface>>& of_faces) {
  return std::any_of(of_faces.begin(), of_faces.end(), [](const std::vector<pfv::Surface>& surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [](const pfv::Surface& surface) { return !surface.is_plane(); });
  });
}

/// A cylinder goes with two planes square to it and nothing else.
bool cylinders_fit(const std::vector<std::vector<pfv::Surface>>& of_faces) {
  std::vector<pfv::Surface> surfaces;
  for (const auto& some : of_faces) surfaces.insert(surfaces.end(), some.begin(), some.end());
  const auto round = [](const pfv::Surface& surface) { return !surface.is_plane(); };
  const auto found = std::find_if(surfaces.begin(), surfaces.end(), round);
  if (found == surfaces.end()) return true;
  return std::count_if(surfaces.begin(), surfaces.end(), round) == 1 &&
         std::all_of(surfaces.begin(), surfaces.end(), [&](const pfv::Surface& surface) {
           return !surface.is_plane() || std::abs(surface.normal.dot(found->axis)) > 1.0 - same;
         });
}

/// The face becomes as many as these of its mesh's walls; a variable feeds them all.
void split(PfvSettings& settings, std::size_t number, const std::vector<std::size_t>& kept, std::size_t parts) {
  const pfv::ContainerFace face = settings.faces[number];
  if (face.boundary.imposes_flux() && kept.size() > 1)
    throw pfv::InputError("face " + face.name + ": its mesh has " + std::to_string(parts) +
                          " walls, and a flux goes through one; make that a mesh of its own");
  const std::vector<PfvBinding> bindings = settings.bindings;
  for (const std::size_t part : kept) {
    const std::size_t at = part == kept.front() ? number : settings.faces.size();
    if (part != kept.front()) {
      settings.faces.push_back(face);
      settings.sources.push_back(settings.sources[number]);
      for (PfvBinding binding : bindings) {
        if (binding.of != PfvBinding::Of::face || binding.number != number) continue;
        binding.number = at;
        settings.bindings.push_back(binding);
      }
    }
    settings.sources[at].part = static_cast<int>(part);
    settings.sources[at].parts = static_cast<int>(parts);
    settings.faces[at].may_bound_nothing = true;  // above a free surface, for instance
    if (parts > 1) settings.faces[at].name = face.name + "_" + std::to_string(part + 1);
  }
}

/// Each patch is on a face that there is, or that has become one of a box.
void check_patches(PfvSettings& settings) {
  pfv::Container container = settings.box;
  if (settings.container) container.faces = settings.faces;
  for (const PfvPatch& part : settings.patches) {
    const std::optional<int> face = container.face_named(part.face);
    if (!face) {
      std::string names;
      for (const pfv::ContainerFace& one : container.faces) names += (names.empty() ? "" : ", ") + one.name;
      throw pfv::InputError("patch: there is no face '" + part.face + "'; there are " + names);
    }
    if (settings.container) continue;
    const int axis = *face / 2, a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    const pfv::ContainerPatch& patch = part.patch;
    settings.box.patches.push_back({static_cast<pfv::Face>(*face),
                                    {patch.lower[a], patch.upper[a], patch.lower[b], patch.upper[b]}, patch.boundary});
  }
}

}  // namespace

std::vector<PfvWall> PfvFoundWalls::walls() const {
  std::vector<PfvWall> walls;
  for (int i = 0; i < modify->nfix; ++i) {
    auto* fix = dynamic_cast<FixWallGran*>(modify->fix[i]);
    if (!fix) continue;
    if (!fix->is_mesh_wall()) walls.push_back({fix->id, fix, nullptr});
    for (int m = 0; fix->is_mesh_wall() && m < fix->n_meshes(); ++m) {
      FixMeshSurface* mesh = fix->mesh_list()[m];
      walls.push_back({mesh->id, nullptr, mesh});
    }
  }
  return walls;
}

Fix* PfvFoundWalls::fix_named(const std::string& id) const {
  const int index = modify->find_fix(id.c_str());
  return index < 0 ? nullptr : modify->fix[index];
}

std::optional<Eigen::Vector3d> PfvFoundWalls::mean_of_grains() const {
  std::array<double, 4> sums{};
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit_)) continue;
    sums[3] += 1.0;
    for (int k = 0; k < 3; ++k) sums[k] += atom->x[i][k];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, world);
  if (!(sums[3] > 0.0)) return {};
  return Eigen::Vector3d(sums[0], sums[1], sums[2]) / sums[3];
}

/// Until there are grains, that of the simulation's box.
Eigen::Vector3d PfvFoundWalls::middle_of_grains() const {
  if (const std::optional<Eigen::Vector3d> mean = mean_of_grains()) return *mean;
  return 0.5 * (Eigen::Vector3d(domain->boxlo[0], domain->boxlo[1], domain->boxlo[2]) +
                Eigen::Vector3d(domain->boxhi[0], domain->boxhi[1], domain->boxhi[2]));
}

bool PfvFoundWalls::grains_lie_aside(const std::vector<Surfaces>& surfaces) const {
  const std::optional<Eigen::Vector3d> mean = mean_of_grains();
  if (!mean) return false;
  for (const Surfaces& some : surfaces)
    for (const pfv::Surface& surface : some)
      if (!surface.is_plane() && surface.distance(*mean) < (1.0 - aside) * surface.radius) return true;
  return false;
}

/// Grains within all surfaces, and the others.
std::pair<long, long> PfvFoundWalls::grains_on_both_sides(const std::vector<pfv::Surface>& surfaces) const {
  std::array<long, 2> counts{};
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit_)) continue;
    const Eigen::Vector3d x(atom->x[i][0], atom->x[i][1], atom->x[i][2]);
    const bool within = std::all_of(surfaces.begin(), surfaces.end(),
                                    [&](const pfv::Surface& surface) { return surface.distance(x) > 0.0; });
    ++counts[within ? 0 : 1];
  }
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_LONG, MPI_SUM, world);
  return {counts[0], counts[1]};
}

/// Empty for a wall that holds the fluid.
std::string PfvFoundWalls::reason_to_leave_out(const PfvWall& wall) const {
  const std::string what = (wall.mesh ? "mesh '" : "wall '") + wall.id + "' ";
  Surfaces surfaces;
  try {
    surfaces = surfaces_of(source_of(wall), wall.id);
  } catch (const pfv::InputError& error) {
    return error.what();
  }
  auto [within, beyond] = grains_on_both_sides(surfaces);
  // a single plane does not say on which side the fluid is
  if (surfaces.size() == 1 && surfaces[0].is_plane() && beyond > within) std::swap(within, beyond);
  if (beyond <= among_grains * static_cast<double>(within + beyond)) return {};
  const bool inner = !wall.mesh && surfaces.size() == 1 && !surfaces[0].is_plane();
  return what + "has " + std::to_string(beyond) + " of " + std::to_string(within + beyond) + " grains on its other side" +
         (wall.mesh ? "; if it stands among the grains, `obstacle mesh " + wall.id + "` makes the fluid see it"
          : inner   ? "; if it stands among the grains, as the inner cylinder of an annulus, take a mesh of its shape in its "
                      "place, and `obstacle mesh ID` for the fluid to see it"
                    : std::string());
}

void PfvFoundWalls::add_walls(PfvSettings& settings, std::vector<std::string>& left_out) const {
  for (const PfvWall& wall : walls()) {
    if (is_source(settings, wall.id)) continue;
    const auto named = std::find_if(settings.faces.begin(), settings.faces.end(),
                                    [&](const pfv::ContainerFace& face) { return face.name == wall.id; });
    const std::string reason = named == settings.faces.end() ? reason_to_leave_out(wall) : std::string();
    if (!reason.empty()) {
      left_out.push_back(reason);
      continue;
    }
    const PfvFaceSource source = source_of(wall);
    if (named != settings.faces.end()) {
      PfvFaceSource& own = settings.sources[static_cast<std::size_t>(named - settings.faces.begin())];
      if (own.kind == Source::none) own = source;
      else left_out.push_back((wall.mesh ? "mesh '" : "wall '") + wall.id +
                              "' is no face, since the face of that name has a place of its own");
      continue;
    }
    pfv::ContainerFace face;
    face.name = wall.id;
    face.wall = *settings.all_walls;
    face.may_bound_nothing = true;
    settings.faces.push_back(face);
    settings.sources.push_back(source);
  }
  for (std::size_t f = 0; f < settings.faces.size(); ++f)
    if (settings.sources[f].kind == Source::none)
      throw pfv::InputError("face " + settings.faces[f].name +
                            ": there is no fix wall/gran and no mesh of one with this ID; define it before fix pfv, or "
                            "give the face a source (plane, wall, mesh or extent)");
}

/// Where the grains end along an axis; without any, the simulation's box.
double PfvFoundWalls::extreme_of_grains(int axis, bool upper) const {
  double furthest = -std::numeric_limits<double>::max();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit_) furthest = std::max(furthest, (upper ? atom->x[i][axis] : -atom->x[i][axis]) + atom->radius[i]);
  MPI_Allreduce(MPI_IN_PLACE, &furthest, 1, MPI_DOUBLE, MPI_MAX, world);
  if (furthest > -std::numeric_limits<double>::max()) return furthest;
  return upper ? domain->boxhi[axis] : -domain->boxlo[axis];
}

/// A face's surfaces, several of a mesh that has them; none where the fix is missing or is no wall, which is said
/// when the faces are bound.
std::vector<pfv::Surface> PfvFoundWalls::surfaces_of(const PfvFaceSource& source, const std::string& face) const {
  std::vector<pfv::Surface> surfaces;
  const std::string what = "face " + face + ": " + (source.kind == Source::mesh ? "mesh '" : "wall '") + source.fix_id + "' ";
  if (source.kind == Source::plane) surfaces.push_back(source.surface);
  if (source.kind == Source::extent) {
    pfv::Surface plane = source.surface;
    Eigen::Index axis = 0;
    plane.normal.cwiseAbs().maxCoeff(&axis);
    plane.offset = extreme_of_grains(static_cast<int>(axis), plane.normal[axis] > 0.0);
    surfaces.push_back(plane);
  }
  if (source.kind == Source::wall)
    if (auto* wall = dynamic_cast<FixWallGran*>(fix_named(source.fix_id)); wall && !wall->is_mesh_wall())
      surfaces.push_back(surface_of(wall, what));
  if (source.kind == Source::mesh)
    if (auto* mesh = dynamic_cast<FixMeshSurface*>(fix_named(source.fix_id)))
      for (const pfv::MeshWall& wall : pfv::walls_of_mesh(triangles_of(mesh, world), source.round, what))
        surfaces.push_back(wall.surface);
  return surfaces;
}

std::vector<PfvFoundWalls::Surfaces> PfvFoundWalls::surfaces_of_faces(PfvSettings& settings, pfv::RoundMeshes round) const {
  std::vector<Surfaces> surfaces;
  for (std::size_t f = 0; f < settings.faces.size(); ++f) {
    settings.sources[f].round = round;
    surfaces.push_back(surfaces_of(settings.sources[f], settings.faces[f].name));
  }
  if (round == pfv::RoundMeshes::as_cylinders) return surfaces;
  Surfaces beside;  // those of meshes that go around
  for (const Surfaces& some : surfaces)
    if (some.size() > 1) beside.insert(beside.end(), some.begin(), some.end());
  for (Surfaces& some : surfaces)
    if (some.size() == 1 && !some[0].is_plane()) some = pfv::flats_around(some[0], beside);
  return surfaces;
}

/// A floor under a hopper's outlet, a second wall in the same place: those that the words do not name go.
void PfvFoundWalls::drop_walls_that_bound_nothing(PfvSettings& settings, std::vector<Surfaces>& surfaces,
                                                  std::size_t named, std::vector<std::string>& left_out) const {
  const Eigen::Vector3d middle = middle_of_grains();
  const double nothing = units_of(update->unit_style)->of_length(1e-12);
  for (std::size_t f = settings.faces.size(); f-- > named;) {
    if (settings.sources[f].kind == Source::periodic) continue;
    std::vector<Surfaces> others = surfaces;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(f));
    const bool behind = surfaces[f].size() == 1 && is_behind_another(f, surfaces[f][0], settings, surfaces, middle);
    const std::optional<double> with = volume_within(surfaces, middle), without = volume_within(others, middle);
    const bool doubled = std::any_of(others.begin(), others.end(), [&](const Surfaces& other) {
      return surfaces[f].size() == 1 && other.size() == 1 && same_plane(surfaces[f][0], other[0], nothing);
    });
    if (!doubled && !behind && (!with || !without || std::abs(*without - *with) > same * *with)) continue;
    left_out.push_back((settings.sources[f].kind == Source::mesh ? "mesh '" : "wall '") + settings.faces[f].name + "' bounds nothing, since others keep the fluid from it");
    remove_wall(settings, surfaces, f);
  }
}

/// The numbers of a face's walls. A cylinder has one plane on either side: the lid of a can above the grains' extreme goes.
std::vector<std::size_t> PfvFoundWalls::kept_parts(const PfvSettings& settings, std::size_t face,
                                                   const std::vector<Surfaces>& surfaces,
                                                   std::vector<std::string>& left_out) const {
  const Eigen::Vector3d middle = middle_of_grains();
  const bool round = any_cylinder(surfaces);
  std::vector<std::size_t> kept;
  for (std::size_t part = 0; part < surfaces[face].size(); ++part) {
    if (!round || !is_behind_another(face, surfaces[face][part], settings, surfaces, middle))
      kept.push_back(part);
    else
      left_out.push_back("wall " + std::to_string(part + 1) + " of mesh '" + settings.sources[face].fix_id +
                         "' bounds nothing, since others keep the fluid from it");
  }
  return kept;
}

void PfvFoundWalls::split_walls(PfvSettings& settings, const std::vector<Surfaces>& surfaces,
                                std::vector<std::string>& left_out) const {
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    const bool mesh = settings.sources[f].kind == Source::mesh;
    const std::size_t parts = surfaces[f].size();
    if (parts > static_cast<std::size_t>(pfv::most_faces))
      throw pfv::InputError("face " + settings.faces[f].name + ": mesh '" + settings.sources[f].fix_id + "' has " +
                            std::to_string(parts) + " planes; a container has at most " +
                            std::to_string(pfv::most_faces) + " faces: make the wall of fewer flats");
    if (parts < 2 && !(mesh && parts == 1 && !surfaces[f][0].is_plane())) continue;
    if (const std::vector<std::size_t> kept = kept_parts(settings, f, surfaces, left_out); !kept.empty())
      split(settings, f, kept, parts);
    if (!mesh)
      for (PfvFaceSource& source : settings.sources)
        if (source.kind == Source::wall && source.part >= 0 && source.fix_id == settings.sources[f].fix_id)
          source.surface = surfaces[f][static_cast<std::size_t>(source.part)];
  }
}

std::vector<std::string> PfvFoundWalls::complete(PfvSettings& settings) const {
  std::vector<std::string> left_out;
  if (!settings.container) return left_out;
  const std::size_t named = settings.faces.size();
  if (settings.all_walls) add_walls(settings, left_out);
  const auto round = settings.flats ? pfv::RoundMeshes::as_flats : pfv::RoundMeshes::as_cylinders;
  std::vector<Surfaces> surfaces = surfaces_of_faces(settings, round);
  const bool periodic = settings.box.any_periodic();
  if (periodic) leave_out_walls_across(settings, surfaces, named, left_out);
  const bool pipe = periodic && !is_cell(settings, surfaces);
  if (pipe) add_periods(settings, surfaces);
  if (settings.all_walls && periodic == pipe) drop_walls_that_bound_nothing(settings, surfaces, named, left_out);
  if (periodic && is_cell(settings, surfaces)) {
    remove_periods(settings, surfaces);
    make_cell(settings, surfaces, named, left_out);
    check_patches(settings);
    return left_out;
  }
  if (!cylinders_fit(surfaces) || grains_lie_aside(surfaces)) surfaces = surfaces_of_faces(settings, pfv::RoundMeshes::as_flats);
  split_walls(settings, surfaces, left_out);
  check_patches(settings);
  if (settings.faces.size() >= 3) return left_out;
  std::string text = "container: it has " + std::to_string(settings.faces.size()) + " faces and takes 3 or more; " +
                     (settings.all_walls ? "give each side that no fix wall/gran of the script closes `face NAME (plane X Y Z "
                                           "NX NY NZ | extent AXIS lo or hi)`, for instance the simulation box's sides"
                                         : "give each wall `face NAME (plane ... | wall FIX_ID | mesh FIX_ID | extent ...)`");
  for (const std::string& reason : left_out) text += "; left out: " + reason;
  throw pfv::InputError(text);
}

}  // namespace LAMMPS_NS
