// SPDX-License-Identifier: GPL-3.0-or-later
// How the faces that follow meshes move: as the nodes of these do, as in the last step, or as their surface does.
#include "face_sources.h"

#include "fix_mesh_surface.h"
#include "tri_mesh.h"

#include <mpi.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace LAMMPS_NS {

/// The rigid motion in the face's plane that is nearest to that of the nodes: their mean velocity about their
/// middle, and the spin by least squares.
void PfvFaceSources::read_gliding(int number) {
  gliding_[number] = {};
  TriMesh* mesh = meshes_[number]->triMesh();
  if (!mesh->isMoving()) return;
  auto* velocities = mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v");
  const int axis = number / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
  // number, places, velocities, moment of the velocities and of the places, by the two other axes
  std::array<double, 7> sums{};
  for (int i = 0; velocities && i < mesh->sizeLocal(); ++i)
    for (int j = 0; j < 3; ++j) {
      double x[3];
      mesh->node(i, j, x);
      const double* v = (*velocities)(i)[j];
      const double terms[7] = {1.0, x[a], x[b], v[a], v[b], x[a] * v[b] - x[b] * v[a],
                               x[a] * x[a] + x[b] * x[b]};
      for (int k = 0; k < 7; ++k) sums[k] += terms[k];
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 7, MPI_DOUBLE, MPI_SUM, world);
  if (sums[0] == 0.0) return;
  for (int k = 1; k < 7; ++k) sums[k] /= sums[0];
  Gliding& gliding = gliding_[number];
  gliding.pivot[a] = sums[1];
  gliding.pivot[b] = sums[2];
  gliding.velocity[a] = sums[3];
  gliding.velocity[b] = sums[4];
  const double spread = sums[6] - sums[1] * sums[1] - sums[2] * sums[2];
  const double moment = sums[5] - sums[1] * sums[4] + sums[2] * sums[3];
  const double size = std::sqrt(std::max(spread, 0.0));
  // what is left of a plain translation is round-off
  const double noise = 1e-9 * (std::abs(sums[3]) + std::abs(sums[4])) * size;
  if (spread > 0.0 && std::abs(moment) > noise) gliding.spin = moment / spread;
}

PfvMeshMotion PfvFaceSources::motion(int number) const {
  if (container_) {
    const pfv::ContainerFace& shape = shapes_[number];
    return {shape.velocity, shape.angular_velocity, shape.pivot};
  }
  const Gliding& gliding = gliding_[number];
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(number / 2);
  return {gliding.velocity + velocities_[number] * along, gliding.spin * along, gliding.pivot};
}

void PfvFaceSources::set_motion(int number, const PfvMeshMotion& motion) {
  if (container_) {
    shapes_[number].velocity = motion.velocity;
    shapes_[number].angular_velocity = motion.spin;
    shapes_[number].pivot = motion.pivot;
    return;
  }
  const int axis = number / 2;
  Gliding& gliding = gliding_[number];
  gliding = {motion.velocity, motion.pivot, motion.spin[axis]};
  velocities_[number] = std::exchange(gliding.velocity[axis], 0.0);
}

pfv::Surface PfvFaceSources::present_surface(int number) const {
  if (container_) return shapes_[number].surface;
  pfv::Surface plane;
  plane.normal = Eigen::Vector3d::Unit(number / 2);
  return plane;
}

/// What the nodes of the mesh do not say.
void PfvFaceSources::settle_motion(int number) {
  if (is_conveyor(number)) {
    PfvMeshMotion rest;
    rest.pivot = motion(number).pivot;
    return set_motion(number, conveyor_motion(meshes_[number], present_surface(number)).value_or(rest));
  }
  set_motion(number, motions_.present(number, meshes_[number], motion(number)));
}

std::vector<std::string> PfvFaceSources::surfaces_at_rest() const {
  std::vector<std::string> lines;
  for (int number = 0; number < count(); ++number)
    if (is_conveyor(number) && !conveyor_motion(meshes_[number], present_surface(number)))
      lines.push_back("face " + names_[number] + ": the surface velocity of mesh '" + sources_[number].fix_id +
                      "' is none that a rigid plane or cylinder has in its own surface; the fluid takes it to be at rest");
  return lines;
}

}  // namespace LAMMPS_NS
