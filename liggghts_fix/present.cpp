// SPDX-License-Identifier: GPL-3.0-or-later
#include "present.h"

#include "atom.h"
#include "fix_mesh_surface.h"
#include "tri_mesh.h"

#include <Eigen/Geometry>
#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace LAMMPS_NS {

namespace {

constexpr int own_sums = 5, mesh_sums = 6;

/// Of the triangles that this rank owns; a mesh at rest has no velocities.
Eigen::Matrix<double, mesh_sums, 1> swept_by(FixMeshSurface* fix) {
  Eigen::Matrix<double, mesh_sums, 1> sums = Eigen::Matrix<double, mesh_sums, 1>::Zero();
  TriMesh* mesh = fix->triMesh();
  auto* velocities = mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v");
  for (int i = 0; velocities && i < mesh->sizeLocal(); ++i) {
    Eigen::Matrix3d corners, moving;
    for (int j = 0; j < 3; ++j) {
      mesh->node(i, j, corners.col(j).data());
      moving.col(j) = Eigen::Map<const Eigen::Vector3d>((*velocities)(i)[j]);
    }
    const Eigen::Vector3d across = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    const Eigen::Vector3d velocity = moving.rowwise().mean();
    const double sweeps = across.dot(velocity);
    sums.head<3>() += Eigen::Vector3d(sweeps, std::abs(sweeps), across.norm() * velocity.norm());
    sums.tail<3>() += across.norm() * velocity;
  }
  return sums;
}

}  // namespace

double PfvPresent::change_of_grains(const PfvPresent& then) const {
  if (newcomers > 0.0 || grains != then.grains) return std::numeric_limits<double>::infinity();
  return grown > 0.0 ? grown / volume : 0.0;
}

bool PfvPresent::meshes_have_jumped(const PfvPresent& then, const pfv::NextSolve& last, double tolerance) const {
  double change = 0.0, fastest = M_PI * then.motion;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Eigen::Matrix<double, mesh_sums, 1> difference = (meshes[m] - then.meshes[m]).cwiseAbs();
    change = std::max({change, difference.head<3>().maxCoeff(), difference.tail<3>().norm()});
    fastest = std::max(fastest, then.meshes[m][2]);
  }
  return last.walls_have_jumped(change, fastest, tolerance);
}

PfvPresent present_of(Atom* atom, int groupbit, double** per_atom, int column,
                      const std::vector<FixMeshSurface*>& meshes, MPI_Comm world) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(own_sums + mesh_sums * static_cast<Eigen::Index>(meshes.size()));
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double* v = atom->v[i];
    const double radius = atom->radius[i], then = per_atom[i][column], volume = radius * radius * radius;
    sums[0] += std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * radius * radius;
    sums[1] += 1.0;
    sums[2] += then == 0.0;
    sums[3] += volume;
    sums[4] += std::abs(volume - then * then * then);
  }
  for (std::size_t m = 0; m < meshes.size(); ++m)
    sums.segment<mesh_sums>(own_sums + mesh_sums * static_cast<Eigen::Index>(m)) = swept_by(meshes[m]);
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, world);
  PfvPresent present{sums[0], sums[1], sums[2], sums[3], sums[4], {}};
  for (Eigen::Index m = own_sums; m < sums.size(); m += mesh_sums) present.meshes.push_back(sums.segment<mesh_sums>(m));
  return present;
}

}  // namespace LAMMPS_NS
