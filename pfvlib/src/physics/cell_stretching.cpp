// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_stretching.hpp"

#include "physics/cell_volumes.hpp"

#include <utility>
#include <vector>

namespace pfv {

namespace {

Eigen::Vector3d offset_of(Vertex vertex, const PoreNetwork& network, const Spheres& grains, const Spheres& vertices) {
  return vertices.centres.col(vertex) - grains.centres.col(network.vertex_sphere[vertex]);
}

/// Where the middle of a facet's spheres is: a wall stretches with its place.
Eigen::Vector3d place_of(const std::array<Vertex, 3>& facet, const Spheres& vertices) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int k = 0; k < 3 && !is_wall(facet[k]); ++k, ++count) sum += vertices.centres.col(facet[k]);
  return sum / count;
}

/// Of each pore the rate (m² times the unit of length) at which dL/dt / L along each axis opens it.
Eigen::Matrix3Xd opened_by_images(const PoreNetwork& network, const Spheres& grains, const Spheres& vertices,
                                  const Throats& throats, const ViscousShares& shares) {
  Eigen::Matrix3Xd opened = Eigen::Matrix3Xd::Zero(3, network.pores());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    const Eigen::Vector3d normal = throats.normal.col(t), to_image = network.throat_offset(t);
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        const auto& facet = network.facet_vertices[f];
        const double area = throats.facet_disc[f][k] + throats.fluid_area[t] * shares[f][k];
        if (area == 0.0) continue;
        const Eigen::Vector3d offset = is_wall(facet[k]) ? place_of(facet, vertices)
                                                         : offset_of(facet[k], network, grains, vertices);
        opened.col(i) += area * normal.cwiseProduct(offset);
        opened.col(j) -= area * normal.cwiseProduct(offset - to_image);
      }
  }
  return opened;
}

/// The axis that face f of a box bounds, where that is periodic, or -1.
int axis_of_end(const Spheres& grains, int f) { return grains.periodic[f / 2] ? f / 2 : -1; }

double sign_of(int face) { return face % 2 == 1 ? 1.0 : -1.0; }

}  // namespace

bool stretches(const Container& container) {
  if (!container.is_box) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis] &&
        container.faces[2 * axis].velocity[axis] != container.faces[2 * axis + 1].velocity[axis])
      return true;
  return false;
}

void add_stretching(ForceMatrix& matrix, const PoreNetwork& network, const Spheres& grains,
                    const Spheres& vertices, const Throats& throats, const ViscousShares& shares) {
  const Eigen::Matrix3Xd opened = opened_by_images(network, grains, vertices, throats, shares);
  ForceMatrix whole;
  whole.spheres = matrix.spheres;
  whole.wall_moments = matrix.wall_moments;
  whole.stretching = true;
  const int sphere_entries = matrix.row_begin[matrix.spheres];
  whole.row_begin.assign(matrix.row_begin.begin(), matrix.row_begin.begin() + matrix.spheres + 1);
  whole.pore.assign(matrix.pore.begin(), matrix.pore.begin() + sphere_entries);
  std::vector<Vector6d> of_faces;
  for (int f = 0; f < grains.wall_count(); ++f) {
    const int axis = axis_of_end(grains, f), row = matrix.spheres + f;
    for (int e = matrix.row_begin[row]; axis < 0 && e < matrix.row_begin[row + 1]; ++e) {
      whole.pore.push_back(matrix.pore[e]);
      of_faces.push_back(matrix.value.col(e));
    }
    for (int pore = 0; axis >= 0 && pore < network.pores(); ++pore) {
      if (opened(axis, pore) == 0.0) continue;
      whole.pore.push_back(pore);
      of_faces.push_back(Vector6d::Unit(axis) * (sign_of(f) * opened(axis, pore) / grains.edges[axis]));
    }
    whole.row_begin.push_back(static_cast<int>(whole.pore.size()));
  }
  whole.value.resize(6, static_cast<Eigen::Index>(whole.pore.size()));
  whole.value.leftCols(sphere_entries) = matrix.value.leftCols(sphere_entries);
  for (std::size_t e = 0; e < of_faces.size(); ++e)
    whole.value.col(sphere_entries + static_cast<Eigen::Index>(e)) = of_faces[e];
  matrix = std::move(whole);
}

void add_stretching(VolumeRateMatrix& matrix, const PoreNetwork& network, const Spheres& grains,
                    const Spheres& vertices) {
  Eigen::Matrix3Xd opened = Eigen::Matrix3Xd::Zero(3, network.pores());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    const auto gradient = cell_volume(cell, vertices).gradient;
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i)
      opened.col(network.cell_pore[c]) += gradient[i].cwiseProduct(offset_of(cell[i], network, grains, vertices));
  }
  VolumeRateMatrix whole;
  whole.spheres = matrix.spheres;
  whole.stretching = true;
  std::vector<Eigen::Vector3d> areas;
  for (int pore = 0; pore < network.pores(); ++pore) {
    for (int e = matrix.row_begin[pore]; e < matrix.row_begin[pore + 1]; ++e) {
      whole.mover.push_back(matrix.mover[e]);
      areas.push_back(matrix.area.col(e));
    }
    for (int f = 0; f < 6; ++f) {
      const int axis = axis_of_end(grains, f);
      if (axis < 0 || opened(axis, pore) == 0.0) continue;
      whole.mover.push_back(wall_vertex(f));
      areas.push_back(Eigen::Vector3d::Unit(axis) * (sign_of(f) * opened(axis, pore) / grains.edges[axis]));
    }
    whole.row_begin.push_back(static_cast<int>(whole.mover.size()));
  }
  whole.area.resize(3, static_cast<Eigen::Index>(areas.size()));
  for (std::size_t e = 0; e < areas.size(); ++e) whole.area.col(static_cast<Eigen::Index>(e)) = areas[e];
  matrix = std::move(whole);
}

}  // namespace pfv
