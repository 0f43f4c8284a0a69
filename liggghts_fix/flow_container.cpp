// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: what holds the fluid, as walls, meshes, grains and variables have it now.
#include "fix_pfv.h"

#include "pfv/error.hpp"

#include "error.h"
#include "input.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace LAMMPS_NS {

namespace {

bool is_inside(const pfv::Container& container, const Eigen::Vector3d& place) {
  return std::all_of(container.faces.begin(), container.faces.end(),
                     [&](const pfv::ContainerFace& face) { return face.surface.distance(place) > 0.0; });
}

}  // namespace

/// Evaluates the variables; of one that is missing, check_variables has told.
void FixPfv::update_bound_numbers() {
  if (settings_.bindings.empty()) return;
  modify->clearstep_compute();
  for (const PfvBinding& binding : settings_.bindings) {
    const int index = input->variable->find(const_cast<char*>(binding.variable.c_str()));
    bound_number(settings_, binding) = input->variable->compute_equal(index);
  }
  modify->addstep_compute(update->ntimestep +
                          (adapts() ? 1 : std::max(1, settings_.steps.couple_every - since_.steps)));
}

namespace {

pfv::Box box_with_conditions(const PfvSettings& settings, const PfvFaceSources& sources) {
  pfv::Box box = settings.box;
  for (int number = 0; number < pfv::face_count; ++number) {
    pfv::FaceCondition& face = box.faces[number];
    if (const auto& cosine = settings.profiles[number]) {
      face.boundary.value = cosine->mean;
      face.boundary.profile = [cosine = *cosine](const Eigen::Vector3d& place, double) {
        return cosine.mean + cosine.amplitude * std::cos(M_PI * place[cosine.axis] / cosine.half_period);
      };
    }
    face = sources.condition(number, face.wall, face.boundary);
  }
  return box;
}

std::vector<pfv::ContainerPatch> patches_of(const PfvSettings& settings, const pfv::Container& container) {
  std::vector<pfv::ContainerPatch> patches;
  for (const PfvPatch& part : settings.patches) {
    patches.push_back(part.patch);
    patches.back().face = *container.face_named(part.face);
  }
  return patches;
}

}  // namespace

/// Boundary conditions and velocities of the faces; their positions follow in place_faces.
pfv::Container FixPfv::current_container() {
  update_bound_numbers();
  if (!settings_.container) {
    pfv::Container box = box_with_conditions(settings_, faces_);
    if (cell_.any()) move_cell(box);
    return box;
  }
  pfv::Container container;
  container.faces = settings_.faces;
  container.periodic = settings_.box.periodic;
  container.pressure_gradient = settings_.box.pressure_gradient;
  container.regions = settings_.box.regions;
  container.patches = patches_of(settings_, container);
  for (int number = 0; number < container.face_count(); ++number) faces_.set_motion(number, container.faces[number]);
  return container;
}

/// The faces of a periodic cell move as the simulation box has moved over the last interval.
void FixPfv::move_cell(pfv::Container& container) const {
  for (int number = 0; number < pfv::face_count; ++number)
    container.faces[number].velocity[number / 2] +=
        settings_.box.periodic[number / 2] ? since_.cell_rates[number] : 0.0;
}

/// Lengths of the cell at the last flow step, m; 0 along axes that are not periodic. Those of a pipe do not change.
Eigen::Vector3d FixPfv::cell_lengths_then() const {
  if (settings_.container) return cell_.lengths();
  Eigen::Vector3d lengths = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (settings_.box.periodic[axis]) lengths[axis] = since_.face_positions[2 * axis + 1] - since_.face_positions[2 * axis];
  return lengths;
}

pfv::Container FixPfv::closed_container(const std::vector<pfv::ContainerFace>& faces) const {
  try {
    return pfv::container_of(faces);
  } catch (const pfv::InputError& problem) {
    throw pfv::InputError(problem.what() + faces_.followers());
  }
}

/// Completes the container where the flow is, and the grains with the obstacles in it.
void FixPfv::place_faces(pfv::Container& container) {
  follow_grains(grains_);
  if (settings_.container) {
    for (int number = 0; number < container.face_count(); ++number)
      container.faces[number].surface = faces_.surface(number);
    if (!flow_ || !pfv::take_bounds(container, flow_->container())) {
      pfv::Container whole = closed_container(container.faces);
      whole.regions = container.regions;
      whole.patches = container.patches;
      whole.periodic = container.periodic;
      whole.pressure_gradient = container.pressure_gradient;
      container = std::move(whole);
    }
  } else {
    faces_.require_room();
    pfv::Box box = *pfv::box_of(container);
    for (const pfv::Face face : pfv::all_faces)
      (pfv::is_upper(face) ? box.upper : box.lower)[pfv::axis_of(face)] =
          faces_.positions()[static_cast<int>(face)];
    container = box;
  }
  obstacles_.add_to(grains_, bodies_, container);
}

void FixPfv::use_mean_velocities_of_faces() {
  for (int number = 0; number < container_.face_count(); ++number) {
    if (settings_.sources[number].kind != PfvFaceSource::Kind::mesh || faces_.is_conveyor(number)) continue;
    Eigen::Vector3d& velocity = container_.faces[number].velocity;
    if (settings_.container)
      velocity = (faces_.pivots()[number] - since_.pivots[number]) / since_.time;
    else
      velocity[number / 2] = (faces_.positions()[number] - since_.face_positions[number]) / since_.time;
  }
}

PfvRestartRecord::Meshes FixPfv::meshes_for_restart() {
  PfvRestartRecord::Meshes meshes{{}, faces_.motions().record(), obstacles_.motions().record()};
  for (const Eigen::Vector3d& pivot : since_.pivots)
    meshes.last_pivots.insert(meshes.last_pivots.end(), pivot.begin(), pivot.end());
  return meshes;
}

/// Throws pfv::InputError where there are meshes and the file is of a form that does not have them.
void FixPfv::restore_meshes(const PfvRestartRecord& record) {
  if (!record.meshes) {
    const auto follows_mesh = [](const PfvFaceSource& source) { return source.kind == PfvFaceSource::Kind::mesh; };
    if (std::none_of(settings_.sources.begin(), settings_.sources.end(), follows_mesh) && settings_.obstacles.empty())
      return;
    throw pfv::InputError("the restart file holds this fix in a form before 10, which does not say how its meshes move; "
                          "write the file with this version, or give the fix another ID to start the flow anew");
  }
  since_.pivots.clear();
  for (std::size_t at = 0; at + 3 <= record.meshes->last_pivots.size(); at += 3)
    since_.pivots.emplace_back(&record.meshes->last_pivots[at]);
  faces_.motions().restore(record.meshes->motions_of_faces);
  obstacles_.motions().restore(record.meshes->motions_of_obstacles);
}

/// Grains that are there but all outside: most likely the box or the units are not those meant. A box
/// that grains will be poured into has none yet, and is left in peace. Where the flow is.
void FixPfv::warn_of_empty_box() const {
  const pfv::Packing packing = grains_.grains();
  bool any = false;
  for (Eigen::Index k = 0; k < packing.size() && !any; ++k) any = is_inside(container_, packing.positions.col(k));
  const PfvGrainTotals grains = totals_of(packing, ranks_);
  if (grains.count == 0.0 || ranks_.any(any)) return;
  std::ostringstream text;
  const auto reach = [&text](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    for (int axis = 0; axis < 3; ++axis)
      text << (axis ? ", " : "") << "xyz"[axis] << " from " << from[axis] << " to " << to[axis];
  };
  text << "all " << grains.count << " grains of the group are outside the "
       << "flow box, the fluid acts on none; the box reaches ";
  reach(container_.lower, container_.upper);
  text << " m, the centres of the grains ";
  reach(grains.lowest_centre, grains.highest_centre);
  text << " m";
  warn_of(text.str());
}

/// Once, whichever ranks hold the flow: all that do know of it.
void FixPfv::warn_of(const std::string& problem) const {
  if (!ranks_.is_first()) return;
  error->warning(FLERR, ("Fix pfv (id " + std::string(id) + "): " + units().relabelled(problem)).c_str());
}

/// Grains that stick in obstacles, conveyors whose motion the fluid cannot have. Where the flow is.
void FixPfv::warn_of_obstacles_and_surfaces() const {
  for (const std::string& line : obstacles_.stuck_grains(grains_.grains(), ranks_)) warn_of(line);
  for (const std::string& line : faces_.surfaces_at_rest()) warn_of(line);
  for (const std::string& line : obstacles_.surfaces_at_rest()) warn_of(line);
}

/// A density in g/cm3. Where the flow is.
void FixPfv::warn_of_light_grains() const {
  constexpr double lightest = 10.0;  // kg/m3
  const pfv::Packing grains = grains_.grains();
  const Eigen::VectorXd masses = grains_.masses();
  double densest = 0.0;
  for (Eigen::Index k = 0; k < grains.size(); ++k)
    if (std::isfinite(masses[k])) densest = std::max(densest, masses[k] / (4.0 / 3.0 * M_PI * std::pow(grains.radii[k], 3)));
  ranks_.take_largest(&densest, 1);
  if (!(densest > 0.0) || densest >= units().of_density(lightest)) return;
  std::ostringstream text;
  text << "no free grain is denser than " << densest << " kg/m3; a density of 2.65 g/cm3 is 2650 kg/m3";
  warn_of(text.str());
}

/// A strain in per cent, sensors in another unit than the script's. Where the flow is.
void FixPfv::warn_of_likely_slips() const {
  warn_of_light_grains();
  constexpr double large = 0.3, never = 100.0;
  const double strain = settings_.options.retriangulation_strain;
  std::ostringstream text;
  if (settings_.given.count("retriangulate") && strain >= large && strain < never) {
    text << "`retriangulate " << strain << "` lets the pores change by " << 100.0 * strain
         << " % before the network is built anew; a strain of 1 % is 0.01";
    warn_of(text.str());
  }
  if (!settings_.sensors) return;
  for (const Eigen::Vector3d& place : settings_.sensors->places) {
    Eigen::Matrix3Xd wrapped = place;
    cell_.wrap(wrapped);
    const double touching = 1e-9 * (container_.upper - container_.lower).norm();
    const auto is_beyond = [&](const pfv::ContainerFace& face) { return face.surface.distance(wrapped) < -touching; };
    if (std::none_of(container_.faces.begin(), container_.faces.end(), is_beyond)) continue;
    text.str("");
    text << "the sensor at (" << place[0] << ", " << place[1] << ", " << place[2]
         << ") m is outside the room of the fluid: it reads the pressure of the nearest place in it";
    warn_of(text.str());
  }
}

/// A face goes on where its mesh ends: a gate, a plate with an opening. Where the flow is.
void FixPfv::warn_of_gaps(const std::vector<double>& mesh_areas) const {
  if (!settings_.container) return;
  constexpr double whole = 0.95;
  const std::vector<double> areas = pfv::face_areas(container_);
  for (std::size_t number = 0; number < areas.size(); ++number) {
    if (mesh_areas[number] == 0.0 || mesh_areas[number] >= whole * areas[number]) continue;
    std::ostringstream text;
    text.precision(3);
    text << "the mesh of face " << container_.faces[number].name << " covers " << 100.0 * mesh_areas[number] / areas[number]
         << " % of it; the fluid's face has no opening there, and grains that pass it are left out";
    warn_of(text.str());
  }
}

/// What became of each wall: a line for the faces of a container, one for each wall that is none. Where the flow is.
void FixPfv::say_what_holds_the_fluid() {
  if (!settings_.container && !settings_.all_walls) return;
  const std::string beginning = "Fix pfv (id " + std::string(id) + "): ";
  std::string text;
  int count = 0;
  for (int number = 0; number < container_.face_count(); ++number)
    if (settings_.sources[number].kind != PfvFaceSource::Kind::periodic)
      text += (count++ ? ", " : "") + faces_.described(number);
  print(beginning + "held by " + std::to_string(count) + " walls: " + units().relabelled(text) + "\n");
  for (const std::string& reason : settings_.left_out) print(beginning + "left out: " + units().relabelled(reason) + "\n");
}

/// Of the grains, without the spheres of obstacles. Where the flow is.
std::int64_t FixPfv::hidden_or_outside() const {
  if (!obstacles_.any()) return flow_->hidden_or_outside();
  const pfv::Packing packing = grains_.grains();
  const std::vector<int> hidden = flow_->hidden();
  std::int64_t count = 0;
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    count += !is_inside(container_, packing.positions.col(k)) || std::find(hidden.begin(), hidden.end(), k) != hidden.end();
  return static_cast<std::int64_t>(ranks_.sum(static_cast<double>(count)));
}

/// Of the grains with their centre in it, m3, over all ranks. Along periodic axes all of them are.
double FixPfv::solid_inside() const {
  const pfv::Packing packing = grains_.grains();
  Eigen::Matrix3Xd places = packing.positions;
  cell_.wrap(places);
  double cubes = 0.0;
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    if (is_inside(container_, places.col(k))) cubes += std::pow(packing.radii[k], 3);
  return ranks_.sum(4.0 / 3.0 * M_PI * cubes);
}

/// A line from which a wrong unit, a box beside the grains or one that is mostly empty is seen. Where the flow is.
void FixPfv::say_what_is_filled() {
  const pfv::Packing packing = grains_.grains();
  const PfvGrainTotals grains = totals_of(packing, ranks_);
  for (const std::string& line : obstacles_.news()) print("Fix pfv (id " + std::string(id) + "): " + units().relabelled(line) + "\n");
  const auto is_grain = [&](int column) { return column < packing.size(); };
  const std::vector<int> hidden = flow_->hidden();
  const std::int64_t seen_nowhere = hidden_or_outside();
  const double outside = static_cast<double>(seen_nowhere) -
                         ranks_.sum(static_cast<double>(std::count_if(hidden.begin(), hidden.end(), is_grain)));
  const double volume = pfv::volume_of(container_);
  char text[300];
  if (grains.count == 0.0)
    std::snprintf(text, sizeof text, "%s of %.4g m3, no grains yet\n", container_.is_box ? "flow box" : "container", volume);
  else
    std::snprintf(text, sizeof text,
                  "%s of %.4g m3, %.0f grains inside, %.0f outside, diameters %.4g to %.4g m, grains are %.3g %% of "
                  "the volume\n",
                  container_.is_box ? "flow box" : "container", volume, grains.count - outside, outside,
                  2.0 * grains.smallest, 2.0 * grains.largest, 100.0 * solid_inside() / volume);
  print("Fix pfv (id " + std::string(id) + "): " + units().relabelled(text));
  if (2.0 * grains.mean_radius > units().of_length(pfv::largest_usual_diameter))
    warn_of("the mean diameter of the grains is " + std::to_string(2.0 * grains.mean_radius) + " m; lengths are in " +
            (&units() == &si_units() ? "m, not mm" : units().length + std::string(" with `units ") + units().style + "`"));
}

}  // namespace LAMMPS_NS
