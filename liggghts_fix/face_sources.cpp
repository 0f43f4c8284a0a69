// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_sources.h"

#include "periodic_cell.h"
#include "private_member.h"
#include "wall_places.h"
#include "wall_shapes.h"

#include "pfv/error.hpp"

#include "domain.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "mesh_module_stress.h"
#include "mesh_module_stress_servo.h"
#include "modify.h"
#include "tri_mesh.h"

#include <Eigen/Geometry>
#include <mpi.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace LAMMPS_NS {

using PfvAxis = double[3];
PFV_PRIVATE_MEMBER(PfvServoAxis, PfvAxis, MeshModuleStressServo, axis_)
PFV_PRIVATE_MEMBER(PfvServoLargest, double, MeshModuleStressServo, ctrl_op_max_)
PFV_PRIVATE_MEMBER(PfvServoSetPoint, double, MeshModuleStressServo, sp_mag_)
PFV_PRIVATE_MEMBER(PfvServoKp, double, MeshModuleStressServo, kp_)
PFV_PRIVATE_MEMBER(PfvServoKi, double, MeshModuleStressServo, ki_)
PFV_PRIVATE_MEMBER(PfvServoKd, double, MeshModuleStressServo, kd_)
PFV_PRIVATE_MEMBER(PfvServoIntegrates, bool, MeshModuleStressServo, int_flag_)
PFV_PRIVATE_MEMBER(PfvServoAutomatic, bool, MeshModuleStressServo, mode_flag_)
PFV_PRIVATE_MEMBER(PfvServoStyle, int, MeshModuleStressServo, ctrl_style_)

namespace {

using Source = PfvFaceSource::Kind;

char axis_name(int number) { return "xyz"[number / 2]; }

/// The same plane with the fluid on its other side.
pfv::Surface turned(pfv::Surface plane) {
  plane.normal = -plane.normal;
  plane.offset = -plane.offset;
  return plane;
}

MeshModuleStress* stress_of(FixMeshSurface* mesh) {
  return mesh ? dynamic_cast<MeshModuleStress*>(mesh->get_module("stress")) : nullptr;
}

/// The servo that controls the mesh's force along the axis, or null.
const MeshModuleStressServo* force_servo(FixMeshSurface* mesh, int axis) {
  constexpr int of_a_force = 3;  // LIGGGHTS' own number, private to its source
  auto* servo = mesh ? dynamic_cast<MeshModuleStressServo*>(mesh->get_module("servo")) : nullptr;
  if (!servo || !stress_of(mesh)) return nullptr;
  const double along = (servo->*member(PfvServoAxis()))[axis];
  return servo->*member(PfvServoIntegrates()) && servo->*member(PfvServoStyle()) == of_a_force &&
                 servo->*member(PfvServoSetPoint()) != 0.0 && std::abs(std::abs(along) - 1.0) < 1e-9
             ? servo
             : nullptr;
}

/// The one that makes it a piston, or null.
const MeshModuleStressServo* piston_servo(FixMeshSurface* mesh, int axis) {
  const MeshModuleStressServo* servo = force_servo(mesh, axis);
  return servo && !(servo->*member(PfvServoAutomatic())) && servo->*member(PfvServoKp()) == 0.0 &&
                 servo->*member(PfvServoKd()) == 0.0 && servo->*member(PfvServoKi()) > 0.0
             ? servo
             : nullptr;
}

}  // namespace

void PfvFaceSources::fail(int number, const std::string& what) const {
  throw pfv::InputError("face " + names_[number] + ": " + what);
}

Fix* PfvFaceSources::find_fix(int number, const std::string& id) const {
  const int index = modify->find_fix(id.c_str());
  if (index < 0)
    fail(number, "there is no fix '" + id + "'; define it before this fix, or give the face a plane where a gate of the "
                 "script goes away");
  return modify->fix[index];
}

int PfvFaceSources::axis_of(int number) const {
  if (!container_) return number / 2;
  const pfv::Surface& surface = shapes_[number].surface;
  for (int axis = 0; axis < 3; ++axis)
    if (surface.is_plane() && std::abs(surface.normal[axis]) == 1.0) return axis;
  return -1;
}

void PfvFaceSources::bind(const PfvSettings& settings) {
  const std::vector<Eigen::Vector3d> before = outward_normals();
  container_ = settings.container;
  sources_ = settings.sources;
  names_.clear();
  for (int number = 0; number < count(); ++number) names_.push_back(face_name(settings, number));
  meshes_.assign(count(), nullptr);
  begun_.assign(count(), 0.0);
  positions_.resize(count(), 0.0);
  velocities_.assign(count(), 0.0);
  gliding_.assign(count(), {});
  shapes_.assign(container_ ? count() : 0, {});
  outwards_.assign(container_ ? count() : 0, 0.0);
  normals_before_ = before.size() == outwards_.size() ? before : std::vector<Eigen::Vector3d>();
  parts_.assign(container_ ? count() : 0, {});
  read_since_bound_ = false;
  for (int number = 0; number < count(); ++number) {
    const PfvFaceSource& source = sources_[number];
    if (container_) shapes_[number].surface = source.surface;
    if (source.kind == Source::plane && !container_) positions_[number] = source.plane;
    if (source.kind == Source::wall) bind_wall(source, number);
    if (source.kind == Source::mesh) bind_mesh(source, number);
    // the words tell which way these look, the rest of the mesh which way its parts do
    if (container_ && (source.kind == Source::plane || source.kind == Source::extent ||
                       source.kind == Source::periodic || source.part >= 0))
      outwards_[number] = 1.0;
  }
}

void PfvFaceSources::bind_wall(const PfvFaceSource& source, int number) {
  auto* wall = dynamic_cast<FixWallGran*>(find_fix(number, source.fix_id));
  if (!wall) fail(number, "fix '" + source.fix_id + "' is no wall/gran; name one that is a primitive plane, or give `plane X`");
  if (wall->is_mesh_wall())
    fail(number, "fix '" + source.fix_id + "' is a mesh wall; name its mesh with `mesh FIX_ID`");
  const std::string what = "face " + names_[number] + ": wall '" + source.fix_id + "' ";
  if (container_) {
    pfv::Surface& surface = shapes_[number].surface;
    surface = surface_of(wall, what);
    if (source.part < 0) return;  // else a flat that touches the cylinder
    const double gap = surface.is_plane() ? surface.offset : source.surface.distance(surface.point) - surface.radius;
    if (surface.is_plane() || std::abs(gap) > 1e-9 * surface.radius)
      fail(number, "wall '" + source.fix_id + "' is another one than when fix pfv was defined; define fix pfv anew");
    surface = source.surface;
    return;
  }
  const pfv::Surface surface = surface_of(wall, what);
  if (!surface.is_plane())
    fail(number, "fix '" + source.fix_id + "' is a cylinder; a face of a box needs a plane: use `container` and "
                 "give each wall a face of its own");
  if (surface.normal[number / 2] != 1.0)
    fail(number, "wall '" + source.fix_id + "' is not normal to the " + axis_name(number) + " axis; name one that is, or use "
                 "`container` and give each wall a face of its own");
  positions_[number] = surface.offset;
}

void PfvFaceSources::bind_mesh(const PfvFaceSource& source, int number) {
  auto* mesh = dynamic_cast<FixMeshSurface*>(find_fix(number, source.fix_id));
  if (!mesh)
    fail(number, "fix '" + source.fix_id + "' is no mesh/surface; name a primitive plane with "
                 "`wall FIX_ID`");
  meshes_[number] = mesh;
  if (source.part >= 0) bind_part(source, number);
}

/// Which triangles make up the part is found anew: the mesh may be another one of the same name.
void PfvFaceSources::bind_part(const PfvFaceSource& source, int number) {
  const std::string what = "mesh '" + source.fix_id + "' ";
  if (meshes_[number]->get_module("servo"))
    fail(number, what + "has several walls or is round and moves under a servo: give each wall that a servo moves a "
                        "plane mesh of its own");
  const std::vector<pfv::MeshWall> walls = pfv::walls_of_mesh(triangles_of(meshes_[number], world), source.round,
                                                              "face " + names_[number] + ": " + what);
  if (static_cast<int>(walls.size()) != source.parts)
    fail(number, what + "has " + std::to_string(walls.size()) + " walls now and had " + std::to_string(source.parts) +
                     " when fix pfv was defined; define fix pfv anew");
  parts_[number] = walls[source.part];
}

std::vector<Eigen::Vector3d> PfvFaceSources::pivots() const {
  std::vector<Eigen::Vector3d> pivots;
  for (const pfv::ContainerFace& shape : shapes_) pivots.push_back(shape.pivot);
  return pivots;
}

void PfvFaceSources::set_motion(int number, pfv::ContainerFace& face) const {
  const pfv::ContainerFace& shape = shapes_[number];
  face.velocity = shape.velocity;
  face.angular_velocity = shape.angular_velocity;
  face.pivot = shape.pivot;
  const int axis = axis_of(number);
  face.guide = axis >= 0 ? Eigen::Vector3d(Eigen::Vector3d::Unit(axis)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// Until grains have been seen, the fluid is where the middle of the simulation's box is.
pfv::Surface PfvFaceSources::surface(int number) const {
  const pfv::Surface& surface = shapes_[number].surface;
  const Eigen::Vector3d middle(0.5 * (domain->boxlo[0] + domain->boxhi[0]), 0.5 * (domain->boxlo[1] + domain->boxhi[1]),
                               0.5 * (domain->boxlo[2] + domain->boxhi[2]));
  return along_periods((outwards_[number] != 0.0 ? outwards_[number] : way_out(number, middle)) < 0.0 ? turned(surface)
                                                                                                      : surface);
}

/// A mesh is parallel to a periodic axis but for rounding.
pfv::Surface PfvFaceSources::along_periods(pfv::Surface surface) const {
  const std::array<bool, 3> periodic = PfvPeriodicCell(lmp).axes();
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic[axis]) continue;
    if (!surface.is_plane() && std::abs(surface.axis[axis]) > 1.0 - same) surface.axis = Eigen::Vector3d::Unit(axis);
    if (!surface.is_plane() || std::abs(surface.normal[axis]) > same || surface.normal[axis] == 0.0) continue;
    Eigen::Vector3d normal = surface.normal;
    normal[axis] = 0.0;
    const double middle = 0.5 * (domain->boxlo[axis] + domain->boxhi[axis]);
    surface = pfv::Surface::plane(normal, (surface.offset - middle * surface.normal[axis]) / normal.squaredNorm() * normal);
  }
  return surface;
}

std::vector<Eigen::Vector3d> PfvFaceSources::outward_normals() const {
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t number = 0; number < outwards_.size(); ++number)
    normals.push_back(outwards_[number] * shapes_[number].surface.normal);
  return normals;
}

/// Of the run before, where it has told: grains may have passed the wall since.
double PfvFaceSources::way_out(int number, const Eigen::Vector3d& inside) const {
  const pfv::Surface& surface = shapes_[number].surface;
  if (!surface.is_plane()) return 1.0;
  constexpr double same_way = 0.5;
  const double along = normals_before_.empty() ? 0.0 : surface.normal.dot(normals_before_[number]);
  if (std::abs(along) > same_way) return along > 0.0 ? 1.0 : -1.0;
  return surface.distance(inside) < 0.0 ? -1.0 : 1.0;
}

std::vector<double> PfvFaceSources::mesh_areas() const {
  std::vector<double> areas(count(), 0.0);
  if (!container_) return areas;
  for (int number = 0; number < count(); ++number) {
    if (!meshes_[number]) continue;
    const std::vector<pfv::Triangle> triangles = triangles_of(meshes_[number], world);
    std::vector<int> chosen(triangles.size());
    std::iota(chosen.begin(), chosen.end(), 0);
    if (sources_[number].part >= 0) chosen = parts_[number].triangles;
    for (const int t : chosen)
      areas[number] += 0.5 * (triangles[t].col(1) - triangles[t].col(0)).cross(triangles[t].col(2) - triangles[t].col(0)).norm();
  }
  return areas;
}

std::string PfvFaceSources::described(int number) const {
  const PfvFaceSource& source = sources_[number];
  const pfv::Surface shape = container_ ? shapes_[number].surface : pfv::Surface();  // a box has planes
  std::ostringstream text;
  text.precision(4);
  text << names_[number] << " (";
  if (source.kind == Source::wall && source.fix_id != names_[number]) text << "wall '" << source.fix_id << "', ";
  if (source.kind == Source::mesh && source.fix_id != names_[number]) text << "mesh '" << source.fix_id << "', ";
  if (source.kind == Source::extent) text << "the grains' extreme, ";
  text << (shape.is_plane() ? "plane" : "cylinder");
  if (!shape.is_plane()) text << " of radius " << shape.radius << " m";
  if (!shape.is_plane() && source.kind == Source::mesh)
    text << " for flats that lie within " << parts_[number].deviation << " m of it";
  text << ")";
  return text.str();
}

/// A wall does not say on which side of it the fluid is: the grains do, when they are first seen.
void PfvFaceSources::turn_outwards(const Eigen::Vector3d& middle) {
  for (int number = 0; number < count(); ++number)
    if (outwards_[number] == 0.0) outwards_[number] = way_out(number, middle);
}

void PfvFaceSources::read() {
  read_parts();
  for (int number = 0; number < count(); ++number) {
    if (meshes_[number] && sources_[number].part >= 0)
      read_motion_of_part(number);
    else if (meshes_[number] && container_)
      read_plane(number);
    else if (meshes_[number])
      read_mesh(number);
    else if (sources_[number].kind == Source::periodic)
      read_end_of_period(number);
    if (meshes_[number]) settle_motion(number);
    if (!container_) continue;
    // any motion changes the distance from some place far off
    const Eigen::Vector3d far(1.7e3, -2.3e3, 3.1e3);
    positions_[number] = shapes_[number].surface.distance(far);
  }
}

/// Where the simulation box ends now.
void PfvFaceSources::read_end_of_period(int number) {
  const int axis = axis_of(number);
  const bool upper = container_ ? shapes_[number].surface.normal[axis] > 0.0 : number % 2 == 1;
  positions_[number] = (upper ? domain->boxhi : domain->boxlo)[axis];
  if (container_) shapes_[number].surface.offset = (upper ? 1.0 : -1.0) * positions_[number];
}

/// All parts of a mesh move as it does.
void PfvFaceSources::read_motion_of_part(int number) {
  if (!meshes_[number]->triMesh()->isMoving()) return;  // at rest since it was bound
  const auto first = static_cast<int>(std::find(meshes_.begin(), meshes_.end(), meshes_[number]) - meshes_.begin());
  pfv::ContainerFace& shape = shapes_[number];
  if (first == number) return set_motion_of_mesh(shape, meshes_[number], world);
  shape.velocity = shapes_[first].velocity;
  shape.angular_velocity = shapes_[first].angular_velocity;
  shape.pivot = shapes_[first].pivot;
}

/// The parts of meshes that move, and once those of all.
void PfvFaceSources::read_parts() {
  std::map<FixMeshSurface*, std::vector<pfv::Triangle>> triangles;
  for (int number = 0; number < count(); ++number) {
    FixMeshSurface* mesh = meshes_[number];
    if (!mesh || sources_[number].part < 0) continue;
    if (read_since_bound_ && !mesh->triMesh()->isMoving()) continue;
    if (triangles.count(mesh) == 0) triangles[mesh] = triangles_of(mesh, world);
    pfv::follow_mesh(parts_[number], triangles[mesh], true);
    shapes_[number].surface = parts_[number].surface;
  }
  read_since_bound_ = true;
}

/// A plane does not say which way its normal points: the same as before.
void PfvFaceSources::read_plane(int number) {
  const Eigen::Vector3d before = shapes_[number].surface.normal;
  pfv::ContainerFace& shape = shapes_[number];
  shape = plane_of_mesh(meshes_[number], world, "face " + names_[number] + ": mesh '" + sources_[number].fix_id + "' ");
  if (shape.surface.normal.dot(before) >= 0.0) return;
  shape.surface = turned(shape.surface);
}

void PfvFaceSources::read_mesh(int number) {
  const int axis = number / 2;
  TriMesh* mesh = meshes_[number]->triMesh();
  auto* node_velocities =
      mesh->isMoving() ? mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v")
                       : nullptr;
  // lowest and negative highest place (0-2, 3-5) and velocity (6, 7): a rank may own no triangle
  std::array<double, 8> local, global;
  local.fill(std::numeric_limits<double>::max());
  for (int i = 0; i < mesh->sizeLocal(); ++i) {
    for (int j = 0; j < 3; ++j) {
      double node[3];
      mesh->node(i, j, node);
      for (int k = 0; k < 3; ++k) {
        local[k] = std::min(local[k], node[k]);
        local[3 + k] = std::min(local[3 + k], -node[k]);
      }
      const double velocity = node_velocities ? (*node_velocities)(i)[j][axis] : 0.0;
      local[6] = std::min(local[6], velocity);
      local[7] = std::min(local[7], -velocity);
    }
  }
  MPI_Allreduce(local.data(), global.data(), 8, MPI_DOUBLE, MPI_MIN, world);

  const auto extent = [&](int k) { return -global[3 + k] - global[k]; };
  if (extent(axis) > pfv::planarity * std::max({extent(0), extent(1), extent(2)})) {
    std::ostringstream text;
    text << "mesh '" << sources_[number].fix_id << "' is not a plane normal to the "
         << axis_name(number) << " axis: its nodes reach from " << global[axis] << " to "
         << -global[3 + axis] << " m along it";
    fail(number, text.str());
  }
  positions_[number] = 0.5 * (global[axis] - global[3 + axis]);
  velocities_[number] = 0.5 * (global[6] - global[7]);
  read_gliding(number);
}

pfv::FaceCondition PfvFaceSources::condition(int number, pfv::Wall wall,
                                             pfv::Boundary boundary) const {
  const Gliding& gliding = gliding_[number];
  return {wall, std::move(boundary), velocities_[number], gliding.velocity, gliding.spin,
          gliding.pivot};
}

bool PfvFaceSources::wants_grains() const {
  const bool any_extent = std::any_of(sources_.begin(), sources_.end(), [](const PfvFaceSource& source) {
    return source.kind == Source::extent;
  });
  const bool any_way_unknown = std::find(outwards_.begin(), outwards_.end(), 0.0) != outwards_.end();
  return any_extent || (container_ && any_way_unknown);
}

void PfvFaceSources::follow_grains(const PfvGrainTotals& grains) {
  if (container_ && grains.count > 0.0) turn_outwards(grains.mean);
  for (int number = 0; number < count(); ++number) {
    if (sources_[number].kind != Source::extent) continue;
    const int axis = axis_of(number);
    const bool upper = container_ ? shapes_[number].surface.normal[axis] > 0.0 : number % 2 == 1;
    const double of_grains = (upper ? grains.upper : grains.lower)[axis];
    const double extreme = grains.count > 0.0 ? of_grains : (upper ? domain->boxhi : domain->boxlo)[axis];
    if (container_) shapes_[number].surface.offset = upper ? extreme : -extreme;
    positions_[number] = extreme;
  }
}

void PfvFaceSources::require_room() const {
  for (int lower = 0; lower < count(); lower += 2) {
    if (positions_[lower] < positions_[lower + 1]) continue;
    std::ostringstream text;
    text << "along " << axis_name(lower) << " its faces leave no room between them: " << names_[lower] << " is at "
         << positions_[lower] << " m, " << names_[lower + 1] << " at " << positions_[lower + 1] << " m";
    const bool follows = sources_[lower].kind == Source::extent || sources_[lower + 1].kind == Source::extent;
    throw pfv::InputError(text.str() + (follows ? followers() : "; give each the wall on its side"));
  }
}

std::string PfvFaceSources::followers() const {
  std::ostringstream text;
  for (int number = 0; number < count(); ++number)
    if (sources_[number].kind == Source::extent)
      text << (text.str().empty() ? "; the place of the outermost grain is that of face " : ", ") << names_[number] << " ("
           << positions_[number] << " m)";
  return text.str().empty() ? "" : text.str() + ": where the grains leave, give a plane in place of `extent`, or end the run";
}

void PfvFaceSources::begin_forces() {
  for (int number = 0; number < count(); ++number)
    if (MeshModuleStress* stress = stress_of(meshes_[number]); stress && axis_of(number) >= 0)
      begun_[number] = stress->f_total(axis_of(number));
}

void PfvFaceSources::read_pistons(bool forces) {
  pistons_.assign(count(), {});
  std::vector<double> of_grains(count(), 0.0);
  bool any = false;
  for (int number = 0; number < count(); ++number) {
    const int axis = axis_of(number);
    const MeshModuleStressServo* servo = axis < 0 ? nullptr : piston_servo(meshes_[number], axis);
    if (!servo) continue;
    any = true;
    // LIGGGHTS keeps the target with the other sign, as the force of the grains that answers it
    const double target = -(servo->*member(PfvServoSetPoint()));
    pistons_[number].mass = std::abs(target) / (servo->*member(PfvServoLargest()) *
                                                servo->*member(PfvServoKi()));
    pistons_[number].other_force = target * (servo->*member(PfvServoAxis()))[axis];
    of_grains[number] = stress_of(meshes_[number])->f_total(axis) - begun_[number];
  }
  if (!forces || !any) return;
  MPI_Allreduce(MPI_IN_PLACE, of_grains.data(), count(), MPI_DOUBLE, MPI_SUM, world);
  for (int number = 0; number < count(); ++number) pistons_[number].other_force += of_grains[number];
}

double PfvFaceSources::largest_load() const {
  if (!any_mesh()) return 0.0;
  std::vector<double> loads(count(), 0.0);
  for (int number = 0; number < count(); ++number)
    if (MeshModuleStress* stress = stress_of(meshes_[number]); stress && axis_of(number) >= 0)
      loads[number] = stress->f_total(axis_of(number)) - begun_[number];
  MPI_Allreduce(MPI_IN_PLACE, loads.data(), count(), MPI_DOUBLE, MPI_SUM, world);
  double largest = 0.0;
  for (const double load : loads) largest = std::max(largest, std::abs(load));
  return largest;
}

std::vector<PfvServoGain> PfvFaceSources::proportional_gains() const {
  std::vector<PfvServoGain> gains(count());
  for (int number = 0; number < count(); ++number) {
    const int axis = axis_of(number);
    const MeshModuleStressServo* servo = axis < 0 ? nullptr : force_servo(meshes_[number], axis);
    if (!servo) continue;
    const double kp = servo->*member(PfvServoKp());
    gains[number] = {std::abs(kp * (servo->*member(PfvServoLargest())) /
                              (servo->*member(PfvServoSetPoint()))),
                     kp};
  }
  return gains;
}

bool PfvFaceSources::any_mesh() const {
  return std::any_of(meshes_.begin(), meshes_.end(), [](const auto* mesh) { return mesh != nullptr; });
}

std::vector<FixMeshSurface*> PfvFaceSources::prescribed_meshes() const {
  std::vector<FixMeshSurface*> meshes;
  for (FixMeshSurface* mesh : meshes_)
    if (mesh && !mesh->get_module("servo") && std::find(meshes.begin(), meshes.end(), mesh) == meshes.end())
      meshes.push_back(mesh);
  return meshes;
}

void PfvFaceSources::push_meshes(const std::vector<Eigen::Vector3d>& forces) const {
  for (int number = 0; number < count(); ++number) {
    if (!meshes_[number]) continue;
    MeshModuleStress* stress = stress_of(meshes_[number]);
    if (!stress) continue;
    Eigen::Vector3d force = forces[number];
    stress->add_global_external_contribution(force.data());
  }
}

}  // namespace LAMMPS_NS
