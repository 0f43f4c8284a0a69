// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_shapes.h"

#include "private_member.h"

#include "pfv/error.hpp"

#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "primitive_wall.h"
#include "tri_mesh.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

namespace LAMMPS_NS {

using PfvWallParameters = double*;
PFV_PRIVATE_MEMBER(PfvPrimitiveParameters, PfvWallParameters, PrimitiveWall, param)

namespace {

using Vector = Eigen::Vector3d;

Vector vector_of(const double* x) { return {x[0], x[1], x[2]}; }

/// Calls visit(place, velocity) for the corners of the triangles of this rank.
void for_each_node(FixMeshSurface* fix, const std::function<void(const Vector&, const Vector&)>& visit) {
  TriMesh* mesh = fix->triMesh();
  auto* velocities = mesh->isMoving()
                         ? mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v")
                         : nullptr;
  for (int i = 0; i < mesh->sizeLocal(); ++i)
    for (int j = 0; j < 3; ++j) {
      double x[3];
      mesh->node(i, j, x);
      visit(vector_of(x), velocities ? vector_of((*velocities)(i)[j]) : Vector(Vector::Zero()));
    }
}

template <std::size_t count>
void add_up(std::array<double, count>& sums, MPI_Comm world) {
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(count), MPI_DOUBLE, MPI_SUM, world);
}

/// Means over the nodes, and their spread about the middle.
struct NodeMeans {
  double count = 0.0;
  Vector place = Vector::Zero(), velocity = Vector::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Vector moment = Vector::Zero();  ///< of the velocities about the middle
};

NodeMeans means_of(FixMeshSurface* fix, MPI_Comm world) {
  std::array<double, 7> first{};
  for_each_node(fix, [&](const Vector& x, const Vector& v) {
    first[0] += 1.0;
    for (int a = 0; a < 3; ++a) {
      first[1 + a] += x[a];
      first[4 + a] += v[a];
    }
  });
  add_up(first, world);
  NodeMeans means;
  means.count = first[0];
  if (!(means.count > 0.0)) return means;
  means.place = Vector(first[1], first[2], first[3]) / means.count;
  means.velocity = Vector(first[4], first[5], first[6]) / means.count;
  std::array<double, 12> second{};
  for_each_node(fix, [&](const Vector& x, const Vector& v) {
    const Vector from = x - means.place, turning = from.cross(v - means.velocity);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) second[3 * a + b] += from[a] * from[b];
      second[9 + a] += turning[a];
    }
  });
  add_up(second, world);
  means.spread = Eigen::Map<const Eigen::Matrix3d>(second.data()) / means.count;
  means.moment = Vector(second[9], second[10], second[11]) / means.count;
  return means;
}

/// Least squares: sum of x cross (w cross x) = sum of x cross v.
Vector angular_velocity(const NodeMeans& means) {
  const Eigen::Matrix3d inertia = means.spread.trace() * Eigen::Matrix3d::Identity() - means.spread;
  const double size = std::sqrt(means.spread.trace());
  const double noise = 1e-9 * means.velocity.norm() * size;  // of a plain translation
  if (!(means.moment.norm() > noise)) return Vector::Zero();
  return inertia.ldlt().solve(means.moment);
}

void set_motion(pfv::ContainerFace& face, const NodeMeans& means) {
  face.velocity = means.velocity;
  face.angular_velocity = angular_velocity(means);
  face.pivot = means.place;
}

/// What all ranks have, in their order.
std::vector<double> gathered(const std::vector<double>& own, MPI_Comm world) {
  int ranks = 1;
  MPI_Comm_size(world, &ranks);
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(ranks), begins(ranks, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int rank = 1; rank < ranks; ++rank) begins[rank] = begins[rank - 1] + counts[rank - 1];
  std::vector<double> all(static_cast<std::size_t>(begins.back()) + counts.back());
  MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), begins.data(), MPI_DOUBLE, world);
  return all;
}

}  // namespace

pfv::Surface surface_of(FixWallGran* wall, const std::string& what) {
  PrimitiveWall* primitive = wall->primitiveWall();
  const double* parameters = primitive->*member(PfvPrimitiveParameters());
  if (const int axis = primitive->axis(); axis >= 0) {
    Vector point = Vector::Zero();
    point[(axis + 1) % 3] = parameters[1];
    point[(axis + 2) % 3] = parameters[2];
    return pfv::Surface::cylinder(Vector::Unit(axis), point, parameters[0]);
  }
  // the way from a place to a plane has one component, that along its axis
  double place[3] = {1.0, 2.0, 4.0}, other[3] = {3.0, 7.0, 9.0}, way[3] = {0.0, 0.0, 0.0}, second[3] = {0.0, 0.0, 0.0};
  primitive->resolveContact(place, 0.0, way);
  primitive->resolveContact(other, 0.0, second);
  for (int axis = 0; axis < 3; ++axis)
    if (way[axis] != second[axis]) {
      pfv::Surface plane;
      plane.normal = Vector::Unit(axis);
      plane.offset = parameters[0];
      return plane;
    }
  throw pfv::InputError(what + "is neither a plane nor a cylinder");
}

pfv::ContainerFace plane_of_mesh(FixMeshSurface* fix, MPI_Comm world, const std::string& what) {
  const NodeMeans means = means_of(fix, world);
  if (!(means.count > 0.0)) throw pfv::InputError(what + "has no triangles");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(means.spread);
  Vector normal = solved.eigenvectors().col(0);
  for (int axis = 0; axis < 3; ++axis)  // a plane normal to an axis is so to the last digit
    if (std::abs(normal[axis]) > 1.0 - 1e-12) normal = Vector::Unit(axis);
  double furthest = 0.0;
  for_each_node(fix, [&](const Vector& x, const Vector&) {
    furthest = std::max(furthest, std::abs(normal.dot(x - means.place)));
  });
  MPI_Allreduce(MPI_IN_PLACE, &furthest, 1, MPI_DOUBLE, MPI_MAX, world);
  if (furthest > pfv::planarity * std::sqrt(means.spread.trace())) {
    std::ostringstream text;
    text << what << "is not a plane: its nodes stray from the nearest one by up to " << furthest
         << " m; give each plane part of it as a mesh of its own";
    throw pfv::InputError(text.str());
  }
  pfv::ContainerFace face;
  face.surface.normal = normal;
  face.surface.offset = normal.dot(means.place);
  set_motion(face, means);
  return face;
}

std::vector<pfv::Triangle> triangles_of(FixMeshSurface* fix, MPI_Comm world) {
  TriMesh* mesh = fix->triMesh();
  constexpr int width = 10;  // number and corners
  std::vector<double> own;
  for (int i = 0; i < mesh->sizeLocal(); ++i) {
    own.push_back(mesh->id(i));
    for (int j = 0; j < 3; ++j) {
      double x[3];
      mesh->node(i, j, x);
      own.insert(own.end(), x, x + 3);
    }
  }
  const std::vector<double> all = gathered(own, world);
  std::map<int, pfv::Triangle> by_number;  // before its first run each rank has the whole mesh
  for (std::size_t i = 0; i + width <= all.size(); i += width)
    by_number[static_cast<int>(all[i])] = Eigen::Map<const pfv::Triangle>(&all[i + 1]);
  std::vector<pfv::Triangle> triangles;
  for (const auto& [number, triangle] : by_number) triangles.push_back(triangle);
  return triangles;
}

void set_motion_of_mesh(pfv::ContainerFace& face, FixMeshSurface* mesh, MPI_Comm world) {
  set_motion(face, means_of(mesh, world));
}

}  // namespace LAMMPS_NS
