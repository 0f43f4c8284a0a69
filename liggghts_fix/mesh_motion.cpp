// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_motion.h"

#include "private_member.h"

#include "fix_mesh_surface.h"
#include "fix_move_mesh.h"
#include "modify.h"
#include "tri_mesh.h"

#include <Eigen/Geometry>

namespace LAMMPS_NS {

using PfvThree = double[3];
PFV_PRIVATE_MEMBER(PfvMoverTime, double, FixMoveMesh, time_)
PFV_PRIVATE_MEMBER(PfvSurfaceVelocity, PfvThree, FixMeshSurface, vSurf_)
PFV_PRIVATE_MEMBER(PfvSurfaceTurns, bool, FixMeshSurface, angVelFlag_)
PFV_PRIVATE_MEMBER(PfvSurfaceOrigin, PfvThree, FixMeshSurface, origin_)
PFV_PRIVATE_MEMBER(PfvSurfaceAxis, PfvThree, FixMeshSurface, axis_)
PFV_PRIVATE_MEMBER(PfvSurfaceSpin, double, FixMeshSurface, omegaSurf_)

namespace {

using Vector = Eigen::Vector3d;

constexpr int kept_width = 10;

}  // namespace

/// A number that each step changes; 0 where no command moves the mesh, or none has yet.
double PfvMeshMotions::moved_for(FixMeshSurface* mesh) const {
  double sum = 0.0, weight = 1.0;
  for (int i = 0; i < modify->nfix; ++i) {
    auto* mover = dynamic_cast<FixMoveMesh*>(modify->fix[i]);
    if (!mover || !mover->fixMeshCompare(mesh)) continue;
    sum += weight * (mover->*member(PfvMoverTime()));
    weight += 1.0;
  }
  return sum;
}

PfvMeshMotion PfvMeshMotions::present(std::size_t number, FixMeshSurface* mesh, const PfvMeshMotion& found) {
  if (kept_.size() <= number) kept_.resize(number + 1);
  Kept& kept = kept_[number];
  const double now = moved_for(mesh);
  if (now == 0.0 || now != kept.moved_for) kept = {now, found};
  return kept.motion;
}

std::vector<double> PfvMeshMotions::record() const {
  std::vector<double> record;
  for (const Kept& kept : kept_) {
    record.push_back(kept.moved_for);
    for (const Vector* three : {&kept.motion.velocity, &kept.motion.spin, &kept.motion.pivot})
      record.insert(record.end(), three->begin(), three->end());
  }
  return record;
}

void PfvMeshMotions::restore(const std::vector<double>& record) {
  kept_.assign(record.size() / kept_width, {});
  const double* next = record.data();
  for (Kept& kept : kept_) {
    kept.moved_for = *next++;
    for (Vector* three : {&kept.motion.velocity, &kept.motion.spin, &kept.motion.pivot}) {
      *three = Eigen::Map<const Vector>(next);
      next += 3;
    }
  }
}

bool is_conveyor(FixMeshSurface* mesh) { return mesh && mesh->surfaceVel() && !mesh->triMesh()->isMoving(); }

/// LIGGGHTS takes the normal component away and leaves the speed.
std::optional<PfvMeshMotion> conveyor_motion(FixMeshSurface* mesh, const pfv::Surface& surface) {
  constexpr double slack = 1e-6;
  const Vector way = surface.is_plane() ? surface.normal : surface.axis;
  PfvMeshMotion motion;
  if (!(mesh->*member(PfvSurfaceTurns()))) {
    const Vector velocity(mesh->*member(PfvSurfaceVelocity()));
    const Vector along = velocity.dot(way) * way, across = velocity - along;
    motion.velocity = surface.is_plane() ? across : along;
    if (!surface.is_plane() && across.norm() > slack * velocity.norm()) return {};
    if (motion.velocity.norm() > slack * velocity.norm()) motion.velocity *= velocity.norm() / motion.velocity.norm();
    else motion.velocity.setZero();  // a plane that looks along the velocity
    return motion;
  }
  const Vector axis = Vector(mesh->*member(PfvSurfaceAxis())).normalized();
  motion.spin = (mesh->*member(PfvSurfaceSpin())) * axis;
  motion.pivot = Vector(mesh->*member(PfvSurfaceOrigin()));
  if (axis.cross(way).norm() > slack) return {};
  if (!surface.is_plane() && (motion.pivot - surface.point).cross(way).norm() > slack * surface.radius) return {};
  motion.spin = motion.spin.dot(way) * way;  // the face stays where it is to the last digit
  if (!surface.is_plane()) motion.pivot = surface.point;
  return motion;
}

}  // namespace LAMMPS_NS
