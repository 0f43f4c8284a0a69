// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a `fix pfv` command, parsed into plain settings. Knows nothing of LIGGGHTS' objects.
#ifndef LMP_PFV_ARGUMENTS_H
#define LMP_PFV_ARGUMENTS_H

#include "pfv/box.hpp"
#include "pfv/darcy_grid.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// A number, or the name of the equal-style variable that gives it anew at each flow step.
struct PfvValue {
  double number = 0.0;
  std::string variable;
};

struct PfvBoundary {
  pfv::Boundary::Kind kind = pfv::Boundary::Kind::sealed;
  PfvValue value;  ///< Pa or m³/s
};

/// p = mean + amplitude cos(pi s / half_period), s the coordinate along `axis`.
struct PfvCosine {
  int axis = 0;
  PfvValue mean, amplitude;  ///< Pa
  double half_period = 1.0;  ///< m
};

struct PfvFace {
  enum class Source { none, plane, wall, mesh, extent };
  Source source = Source::none;
  double plane = 0.0;  ///< m
  std::string fix_id;  ///< of the wall or mesh
  pfv::Wall wall = pfv::Wall::no_slip;
  PfvBoundary boundary;
  std::optional<PfvCosine> profile;
};

struct PfvPatch {
  pfv::Face face;
  std::array<double, 4> rectangle;
  PfvBoundary boundary;
};

struct PfvRegion {
  Eigen::Vector3d lower, upper;  ///< m; equal: a point
  PfvBoundary boundary;
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

struct PfvFieldOutput {
  int every;
  std::string path;  ///< ends in .pvd
};

enum class PfvCoupling {
  explicit_forces,  ///< of the velocities at the beginning of the step
  staged,           ///< the drag is integrated over the step
  implicit,         ///< of the velocities at the end of the step
  automatic         ///< what is cheapest and stable, chosen for each network
};

struct PfvSettings {
  pfv::Fluid fluid;  ///< gravity is set later, from `fix gravity`
  pfv::Options options;
  std::optional<pfv::DarcyOptions> grid;  ///< absent: the pore network
  std::array<PfvFace, 6> faces;
  std::vector<PfvPatch> patches;
  std::vector<PfvRegion> regions;
  int couple_every = 1;  ///< steps between two solves of the flow
  /// In its place, by default: as the loads change, with this error, as a part of the load. Absent where each
  /// step or each N-th is solved.
  std::optional<double> couple_error = default_couple_error;
  static constexpr double default_couple_error = 1e-3;
  PfvCoupling coupling = PfvCoupling::explicit_forces;
  bool time_step_check = true;
  double safety = 1.0;  ///< part of the explicit limit that a step may reach
  std::optional<PfvFieldOutput> fields;
  std::optional<PfvProfileOutput> profile, flux_profile;
  std::optional<PfvSensorOutput> sensors;
  std::optional<std::string> culprits;  ///< file for what an error is about
};

/// The settings of `fix ID group pfv ...`; `arg` holds the words behind the style. Throws
/// pfv::InputError.
PfvSettings parse_pfv(int narg, char** arg);

/// Applies one keyword of `fix_modify ID ...` and returns the number of words it took. Throws
/// pfv::InputError, also for a keyword that cannot be modified.
int modify_pfv(PfvSettings& settings, int narg, char** arg);

/// Every value of the settings that may be a variable.
std::vector<const PfvValue*> values_of(const PfvSettings& settings);

}  // namespace LAMMPS_NS

#endif
