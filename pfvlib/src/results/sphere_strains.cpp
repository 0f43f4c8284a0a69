// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sphere_strains.hpp"

#include "geometry/tensor_rows.hpp"
#include "pfv/error.hpp"
#include "results/tensor_fields.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <string>
#include <utility>
#include <vector>

namespace pfv {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Places of the network's spheres, of ghosts as their owners have them.
Eigen::Matrix3Xd at_spheres(const BuiltNetwork& built, const Eigen::Matrix3Xd& of_packing) {
  const int count = built.grains.spheres.size();
  Eigen::Matrix3Xd places(3, count);
  for (int k = 0; k < count; ++k)
    if (built.share.owns_sphere(k)) places.col(k) = of_packing.col(built.grains.columns[k]);
  if (built.share.ranks) built.share.spheres.refresh(*built.share.ranks, places);
  return places;
}

/// Of one cell, times six: its volume V now, and V times the gradient of the displacement, which is linear in it: what
/// the displacement times the normal makes over its facets (Catalano 2012, eq. 2.20).
struct CellSum {
  double volume = 0.0;
  Matrix3d gradient = Matrix3d::Zero();
};

class DisplacedCells {
 public:
  DisplacedCells(const BuiltNetwork& built, const Container& cell, const Displaced& moved)
      : built_(built),
        now_(at_spheres(built, moved.now)),
        before_(at_spheres(built, moved.before)),
        lattice_now_{cell.upper - cell.lower, cell.tilt, cell.periodic},
        lattice_before_{moved.edges_before.value_or(Vector3d::Ones()), moved.tilt_before.value_or(Vector3d::Zero()),
                        cell.periodic} {}

  int sphere(Vertex vertex) const { return built_.network.vertex_sphere[vertex]; }

  /// Nothing where a wall or a sphere that was not there before is among its corners.
  CellSum sum_of(int cell) const {
    const auto& corners = built_.network.cell_vertices[cell];
    Matrix3d edges, moved;
    for (const Vertex corner : corners)
      if (is_wall(corner) || !before_.col(sphere(corner)).allFinite()) return {};
    for (int k = 0; k < 3; ++k) {
      edges.col(k) = way(corners[0], corners[k + 1]);
      moved.col(k) = edges.col(k) - way_before(corners[0], corners[k + 1], edges.col(k));
    }
    Matrix3d normals;
    normals.row(0) = edges.col(1).cross(edges.col(2));
    normals.row(1) = edges.col(2).cross(edges.col(0));
    normals.row(2) = edges.col(0).cross(edges.col(1));
    return {normals.row(0).dot(edges.col(0)), moved * normals};
  }

 private:
  /// Between the images that the cell has, which stood where the network was built not far from where they are now.
  Vector3d way(Vertex from, Vertex to) const {
    const Vector3d apart = now_.col(sphere(to)) - now_.col(sphere(from));
    const Vector3d then = built_.vertices.centres.col(to) - built_.vertices.centres.col(from);
    return apart + lattice_now_.displacement(lattice_now_.nearest(then - apart));
  }
  Vector3d way_before(Vertex from, Vertex to, const Vector3d& way_now) const {
    const Vector3d apart = now_.col(sphere(to)) - now_.col(sphere(from));
    const Lattice::Shift periods = lattice_now_.nearest(way_now - apart);
    return before_.col(sphere(to)) - before_.col(sphere(from)) + lattice_before_.displacement(periods);
  }

  const BuiltNetwork& built_;
  Eigen::Matrix3Xd now_, before_;
  Lattice lattice_now_, lattice_before_;
};

/// The gradient is taken over places now; that over places before is (1 - gradient)^-1 - 1.
TensorRows strain_of(const CellSum& around) {
  constexpr double torn = 0.1;
  if (!(around.volume > 0.0)) return TensorRows::Zero();
  const Matrix3d back = Matrix3d::Identity() - around.gradient / around.volume;
  if (!(back.determinant() > torn)) return TensorRows::Zero();
  const Matrix3d gradient = back.inverse() - Matrix3d::Identity();
  return tensor_rows(gradient);
}

void require_places(const Displaced& moved, const Container& cell, Eigen::Index packed) {
  for (const Eigen::Matrix3Xd* places : {&moved.now, &moved.before})
    if (places->cols() != packed)
      throw InputError("sphere_strains: " + std::to_string(places->cols()) + " places of " + std::to_string(packed) +
                       " spheres; give one for each sphere of the packing");
  if (!moved.now.allFinite())
    throw InputError("sphere_strains: a place is not finite; only those before may be, of spheres that were not there");
  for (int axis = 0; axis < 3; ++axis)
    if (cell.periodic[axis] && !(moved.edges_before && (*moved.edges_before)[axis] > 0.0))
      throw InputError("sphere_strains: the cell is periodic; give the lengths of its edges as they were before");
  if (!cell.tilt.isZero(0.0) && !moved.tilt_before)
    throw InputError("sphere_strains: the cell is tilted; give its tilt as it was before");
}

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_strains(const BuiltNetwork& built, const Container& cell,
                                                        const Displaced& moved, Eigen::Index packed) {
  require_places(moved, cell, packed);
  const DisplacedCells cells(built, cell, moved);
  std::vector<CellSum> around(built.grains.spheres.size());
  for (int c = 0; c < built.network.cells(); ++c) {
    const CellSum sum = cells.sum_of(c);
    if (sum.volume == 0.0) continue;
    for (const Vertex corner : built.network.cell_vertices[c]) {
      around[cells.sphere(corner)].volume += sum.volume;
      around[cells.sphere(corner)].gradient += sum.gradient;
    }
  }
  Eigen::Matrix<double, 6, Eigen::Dynamic> strains = decltype(strains)::Zero(6, packed);
  for (int k = 0; k < built.grains.spheres.size(); ++k)
    if (built.share.owns_sphere(k)) strains.col(built.grains.columns[k]) = strain_of(around[k]);
  return strains;
}

std::vector<Field> strain_fields(Eigen::Matrix<double, 6, Eigen::Dynamic> strains) {
  return tensor_fields("strain", std::move(strains), 2.0 / 3.0);
}

}  // namespace pfv
