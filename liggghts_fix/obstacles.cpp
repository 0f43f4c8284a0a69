// SPDX-License-Identifier: GPL-3.0-or-later
#include "obstacles.h"

#include "wall_shapes.h"

#include "pfv/error.hpp"

#include "atom.h"
#include "fix_mesh_surface.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "tri_mesh.h"

#include <Eigen/Geometry>
#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

namespace LAMMPS_NS {

namespace {

/// Beyond every tag of a grain: obstacle by obstacle, sphere by sphere.
constexpr std::int64_t first_obstacle_id = 10'000'000'000;

std::string named(const std::string& id) { return "obstacle: mesh '" + id + "' "; }

std::string described(const pfv::Obstacle& obstacle) {
  std::ostringstream text;
  text.precision(3);
  text << obstacle.size() << " spheres in place of its " << obstacle.solids << " closed and " << obstacle.sheets
       << " open parts; ";
  if (obstacle.solids > 0)
    text << "volume " << obstacle.volume << " m3 (spheres: " << obstacle.union_volume << "), edges rounded by up to "
         << obstacle.recess << " m, ";
  text << (obstacle.sheets > 0 ? "sheets are " : "they stand out by up to ")
       << (obstacle.sheets > 0 ? 2.0 : 1.0) * obstacle.protrusion << (obstacle.sheets > 0 ? " m thick" : " m");
  return text.str();
}

/// A sum over ranks ends in digits that depend on their number, by which a mesh may need a sphere more or less.
double to_nine_digits(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 8.0);
  return step * std::round(value / step);
}

void append(std::vector<double>& record, const double* first, Eigen::Index count) {
  record.insert(record.end(), first, first + count);
}

}  // namespace

FixMeshSurface* PfvObstacles::mesh_named(const std::string& id) const {
  const int index = modify->find_fix(id.c_str());
  auto* mesh = index < 0 ? nullptr : dynamic_cast<FixMeshSurface*>(modify->fix[index]);
  if (!mesh) throw pfv::InputError("obstacle: there is no fix mesh/surface '" + id + "'; define it before this fix");
  return mesh;
}

double PfvObstacles::usual_diameter(const std::string& what, int groupbit) const {
  double sums[2] = {0.0, 0.0};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      sums[0] += 2.0 * atom->radius[i];
      sums[1] += 1.0;
    }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, world);
  if (sums[1] == 0.0)
    throw pfv::InputError(what + "takes its spheres' size from the grains, and there are none yet; give it "
                                 "`diameter D`, some half of the grains' diameter (m)");
  return to_nine_digits(pfv::usual_obstacle_diameter * sums[0] / sums[1]);
}

/// Between runs a mesh may be moved, or replaced by another of the same name.
bool PfvObstacles::has_kept_its_shape(const Held& held, const std::vector<pfv::Triangle>& now,
                                      const std::string& what) const {
  if (held.reference.size() != now.size()) return false;
  try {
    pfv::placement_between(held.reference, now, what);
  } catch (const pfv::InputError&) {
    return false;
  }
  return true;
}

void PfvObstacles::bind(const PfvSettings& settings, int groupbit) {
  held_.resize(settings.obstacles.size());
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    const PfvObstacleSource& source = settings.obstacles[i];
    held.id = source.fix_id;
    held.mesh = mesh_named(held.id);
    held.read = false;
    std::vector<pfv::Triangle> triangles = triangles_of(held.mesh, world);
    if (!held.reference.empty() && has_kept_its_shape(held, triangles, named(held.id))) continue;
    const double diameter = source.diameter > 0.0 ? source.diameter : usual_diameter(named(held.id), groupbit);
    held.obstacle = pfv::obstacle_of_mesh(triangles, diameter, named(held.id));
    held.reference = std::move(triangles);
    held.dealt = false;
    held.fresh = true;
  }
}

std::vector<FixMeshSurface*> PfvObstacles::meshes() const {
  std::vector<FixMeshSurface*> meshes;
  for (const Held& held : held_) meshes.push_back(held.mesh);
  return meshes;
}

void PfvObstacles::read() {
  for (Held& held : held_) {
    if (held.read && !held.mesh->triMesh()->isMoving()) continue;
    held.motion.placement = pfv::placement_between(held.reference, triangles_of(held.mesh, world), named(held.id));
    pfv::ContainerFace motion;
    if (held.mesh->triMesh()->isMoving()) set_motion_of_mesh(motion, held.mesh, world);
    const PfvMeshMotion present =
        motions_.present(&held - held_.data(), held.mesh, {motion.velocity, motion.angular_velocity, motion.pivot});
    held.motion.velocity = present.velocity;
    held.motion.spin = present.spin;
    held.motion.pivot = present.pivot;
    held.read = true;
  }
}

Eigen::Matrix3Xd PfvObstacles::spheres() const {
  Eigen::Index count = 0, next = 0;
  for (const Held& held : held_) count += held.obstacle.size();
  Eigen::Matrix3Xd places(3, count);
  for (const Held& held : held_)
    for (const auto centre : held.obstacle.centres.colwise()) places.col(next++) = held.motion.placement.of(centre);
  return places;
}

void PfvObstacles::deal(const std::vector<int>& ranks, int own) {
  std::size_t next = 0;
  for (Held& held : held_) {
    held.own.clear();
    held.dealt = true;
    for (int k = 0; k < held.obstacle.size(); ++k)
      if (ranks[next++] == own) held.own.push_back(k);
  }
}

bool PfvObstacles::are_undealt() const {
  return std::any_of(held_.begin(), held_.end(), [](const Held& held) { return !held.dealt; });
}

Eigen::Matrix3Xd PfvObstacles::own_spheres() const {
  std::vector<int> own;
  int first = 0;
  for (const Held& held : held_) {
    for (const int k : held.own) own.push_back(first + k);
    first += static_cast<int>(held.obstacle.size());
  }
  return spheres()(Eigen::all, own);
}

void PfvObstacles::add_to(PfvGrainExchange& grains, PfvBodies& bodies, const pfv::Container& container) {
  std::int64_t id = first_obstacle_id;
  for (Held& held : held_) {
    if (!held.dealt) {
      held.own.resize(held.obstacle.size());
      std::iota(held.own.begin(), held.own.end(), 0);
    }
    const pfv::ObstaclePart part{held.own, static_cast<int>(bodies.rigid().size())};
    grains.add(held.obstacle, part, held.motion, id, container);
    bodies.add_held(pfv::held_body(held.obstacle, part, held.motion.placement));
    id += pfv::most_obstacle_spheres;
  }
}

void PfvObstacles::take_loads(const PfvGrainExchange& grains, const pfv::Forces& forces, const PfvFlowRanks& ranks) {
  Eigen::Index first = grains.grain_count();
  for (Held& held : held_) {
    const auto count = static_cast<Eigen::Index>(held.own.size());
    held.load = pfv::load_on(grains.packing(), forces, first, count, held.motion.placement.of(held.obstacle.centre));
    ranks.add(held.load.force.data(), 3);
    ranks.add(held.load.moment.data(), 3);
    first += count;
  }
}

void PfvObstacles::push() const {
  for (const Held& held : held_) {
    auto* stress = dynamic_cast<MeshModuleStress*>(held.mesh->get_module("stress"));
    if (!stress) continue;
    // components 6-8 are the mesh's own reference point
    const Eigen::Vector3d point(stress->compute_vector(6), stress->compute_vector(7), stress->compute_vector(8));
    const Eigen::Vector3d arm = held.motion.placement.of(held.obstacle.centre) - point;
    Eigen::Vector3d force = held.load.force, moment = held.load.moment + arm.cross(held.load.force);
    stress->add_global_external_contribution(force.data(), moment.data());
  }
}

Eigen::Vector3d PfvObstacles::force() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Held& held : held_) sum += held.load.force;
  return sum;
}

double PfvObstacles::load(int component) const {
  const pfv::ObstacleLoad& load = held_[component / 6].load;
  return component % 6 < 3 ? load.force[component % 6] : load.moment[component % 6 - 3];
}

std::vector<double> PfvObstacles::places() const {
  std::vector<double> places;
  for (const Held& held : held_) {
    append(places, held.motion.placement.turn.data(), 9);
    append(places, held.motion.placement.shift.data(), 3);
  }
  return places;
}

std::vector<std::string> PfvObstacles::news() {
  std::vector<std::string> lines;
  for (Held& held : held_)
    if (std::exchange(held.fresh, false)) lines.push_back("obstacle " + held.id + ": " + described(held.obstacle));
  return lines;
}

std::vector<std::string> PfvObstacles::stuck_grains(const pfv::Packing& grains, const PfvFlowRanks& ranks) const {
  std::vector<std::string> lines;
  for (const Held& held : held_) {
    const std::vector<std::int64_t> own = pfv::spheres_stuck_in(grains, held.obstacle, held.motion.placement);
    const std::vector<double> all = ranks.everywhere(std::vector<double>(own.begin(), own.end()));
    const std::string warning = pfv::warning_of_stuck(std::vector<std::int64_t>(all.begin(), all.end()));
    if (!warning.empty()) lines.push_back(named(held.id) + "is not clear of grains: " + warning);
  }
  return lines;
}

std::vector<std::string> PfvObstacles::surfaces_at_rest() const {
  std::vector<std::string> lines;
  for (const Held& held : held_)
    if (is_conveyor(held.mesh))
      lines.push_back(named(held.id) + "has a surface velocity, which its spheres do not have; the fluid takes it to be "
                                       "at rest");
  return lines;
}

std::vector<double> PfvObstacles::record() const {
  std::vector<double> record{static_cast<double>(held_.size())};
  for (const Held& held : held_) {
    const pfv::Obstacle& own = held.obstacle;
    record.insert(record.end(), {static_cast<double>(own.size()), static_cast<double>(held.reference.size()),
                                 static_cast<double>(own.solids), static_cast<double>(own.sheets), own.volume,
                                 own.union_volume, own.recess, own.protrusion});
    append(record, own.centre.data(), 3);
    append(record, own.centres.data(), own.centres.size());
    append(record, own.radii.data(), own.size());
    append(record, own.displaced.data(), own.size());
    for (const pfv::Triangle& triangle : held.reference) append(record, triangle.data(), 9);
  }
  return record;
}

void PfvObstacles::restore(const std::vector<double>& record) {
  const double* next = record.data();
  held_.assign(record.empty() ? 0 : static_cast<std::size_t>(*next++), {});
  for (Held& held : held_) {
    pfv::Obstacle& own = held.obstacle;
    const auto spheres = static_cast<Eigen::Index>(next[0]);
    held.reference.resize(static_cast<std::size_t>(next[1]));
    own.solids = static_cast<int>(next[2]);
    own.sheets = static_cast<int>(next[3]);
    own.volume = next[4];
    own.union_volume = next[5];
    own.recess = next[6];
    own.protrusion = next[7];
    own.centre = Eigen::Map<const Eigen::Vector3d>(next + 8);
    next += 11;
    own.centres = Eigen::Map<const Eigen::Matrix3Xd>(next, 3, spheres);
    own.radii = Eigen::Map<const Eigen::VectorXd>(next + 3 * spheres, spheres);
    own.displaced = Eigen::Map<const Eigen::VectorXd>(next + 4 * spheres, spheres);
    next += 5 * spheres;
    for (pfv::Triangle& triangle : held.reference) {
      triangle = Eigen::Map<const pfv::Triangle>(next);
      next += 9;
    }
  }
}

}  // namespace LAMMPS_NS
