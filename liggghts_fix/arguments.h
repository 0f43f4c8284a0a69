// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a `fix pfv` command, parsed into the library's types, and which variables feed their numbers.
// Knows nothing of LIGGGHTS' objects.
#ifndef LMP_PFV_ARGUMENTS_H
#define LMP_PFV_ARGUMENTS_H

#include "script_units.h"

#include "pfv/container.hpp"
#include "pfv/mesh_walls.hpp"
#include "pfv/settings.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Where a face is.
struct PfvFaceSource {
  enum class Kind { none, plane, wall, mesh, extent, periodic };
  Kind kind = Kind::none;
  double plane = 0.0;  ///< of a box, m
  std::string fix_id;  ///< of the wall or mesh
  pfv::Surface surface;  ///< plane, flat of a primitive cylinder or, with `extent`, its direction: of a container
  int part = -1;   ///< which of the walls of a mesh or primitive cylinder that is several, or of a round mesh; -1: one plane
  int parts = 1;   ///< how many walls that mesh has, also those that bound nothing
  pfv::RoundMeshes round = pfv::RoundMeshes::as_cylinders;
};

/// p = mean + amplitude cos(pi s / half_period), s the coordinate along `axis`.
struct PfvCosine {
  int axis = 0;
  double mean = 0.0, amplitude = 0.0;  ///< Pa
  double half_period = 1.0;            ///< m
};

/// A number that an equal-style variable gives anew at each flow step.
struct PfvBinding {
  enum class Of { face, patch, region, mean, amplitude, gradient };
  Of of = Of::face;
  std::size_t number = 0;  ///< of the face, patch, region or axis
  std::string variable;
};

/// Rows of a quantity on equally spaced planes.
struct PfvProfileOutput {
  int axis, planes, every;
  std::string path;
};

struct PfvSensorOutput {
  std::vector<Eigen::Vector3d> places;  ///< m
  int every;
  std::string path;
};

struct PfvHistoryOutput {
  int every;
  std::string path;
};

struct PfvFieldOutput {
  int every;
  std::string path;  ///< ends in .pvd
  bool contact_stress = false;  ///< with the stresses that contacts and motion cause
};

/// A part of a face of a container, by the face's name: it may still have to be found.
struct PfvPatch {
  std::string face;
  pfv::ContainerPatch patch;
};

/// A mesh that stands among the grains.
struct PfvObstacleSource {
  std::string fix_id;
  double diameter = 0.0;  ///< of its smallest spheres, m; 0: from the grains
};

/// Gravity is set later, from `fix gravity`; so are positions and velocities of the box' faces.
struct PfvSettings : pfv::Settings {
  pfv::Box box;
  /// In place of the box's faces: a container of walls as they are.
  bool container = false;
  /// The walls that the grains touch are faces of the container, with this condition unless they are named.
  std::optional<pfv::Wall> all_walls;
  bool flats = false;  ///< round meshes stay the flats that they are made of
  std::vector<pfv::ContainerFace> faces;
  std::vector<PfvFaceSource> sources = std::vector<PfvFaceSource>(6);  ///< of the box's faces, or of these
  std::vector<PfvPatch> patches;  ///< of the container; those of a box are its own
  std::array<std::optional<PfvCosine>, 6> profiles;
  std::vector<std::string> left_out;  ///< walls that are no faces, each with the reason
  std::vector<PfvObstacleSource> obstacles;
  std::vector<PfvBinding> bindings;
  std::optional<PfvFieldOutput> fields;
  std::optional<PfvProfileOutput> profile, flux_profile;
  std::optional<PfvSensorOutput> sensors;
  std::optional<PfvHistoryOutput> history;
  std::optional<std::string> culprits;  ///< file for what an error is about
};

/// The settings of `fix ID group pfv ...`; `arg` holds the words behind the style. Throws
/// pfv::InputError. `periodic`: axes along which the simulation box is periodic; they have no faces to give; `units`:
/// of the words, which the defaults are converted to. Of a container the walls have still to be found
/// (`PfvFoundWalls::complete`).
PfvSettings parse_pfv(int narg, char** arg, const std::array<bool, 3>& periodic, const PfvUnits& units);

/// Applies one keyword of `fix_modify ID ...` and returns the number of words it took. Throws
/// pfv::InputError, also for a keyword that cannot be modified.
int modify_pfv(PfvSettings& settings, int narg, char** arg);

/// The number that a binding feeds.
double& bound_number(PfvSettings& settings, const PfvBinding& binding);

/// "zlo", or the name that a face of a container has.
std::string face_name(const PfvSettings& settings, int face);

}  // namespace LAMMPS_NS

#endif
