// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace pfv {

/// A vertex of a tetrahedron: k >= 0 is sphere k, -1, -2, ... are the walls in the order of the
/// container's faces (xlo ... zhi of a box).
using Vertex = int;
inline bool is_wall(Vertex vertex) { return vertex < 0; }
inline int wall_number(Vertex vertex) { return -1 - vertex; }
inline Vertex wall_vertex(int face) { return -1 - face; }

/// Some faces of a container: bit f is face f.
using FaceSet = std::uint64_t;
inline FaceSet face_bit(int face) { return FaceSet{1} << face; }

/// The pore space as a graph (Chareyre et al. 2012, sec. 2): plain arrays, indices only.
///
/// A *cell* is a tetrahedron of the regular triangulation; with walls among its vertices it is a prism
/// on a face, a slab on an edge or a block in a corner of the box. A *pore* is a cell, or several cells
/// that share one dual vertex (cospherical sets: they hold one pressure). A *facet* is shared by two
/// cells; a *throat* is the planar polygon between two pores: one facet, or several pieces of it.
///
/// All is numbered from the spheres' ids and places and the box alone, so that a network and what is
/// computed on it do not depend on the order of the packing's columns, nor on who triangulated:
/// - cells by the first of their spheres along a Hilbert curve through the box, then by the second, and so
///   on, walls last; pores by their first cell;
/// - the vertices of a cell by ids, then walls in their order, but for the last two spheres (or walls, with
///   fewer than three spheres), which the orientation may exchange; a facet of three spheres begins with
///   its lowest id; images of one sphere count by place;
/// - a throat goes from the pore with the smaller number to the larger, and throats stand by their first
///   pores, then by their second ones (then by the image). The facets of a throat stand by the smaller of
///   their two cells; within a merged pore that is cell 0.
struct PoreNetwork {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< lower corner of the box around the container: all places below
                                                     ///< are relative to it, m

  /// The sphere that a vertex k >= 0 stands for: k itself without periodic axes; with them vertices are
  /// images, of which several may belong to one sphere.
  std::vector<int> vertex_sphere;

  // one entry a cell
  std::vector<std::array<Vertex, 4>> cell_vertices;  ///< spheres first, positively oriented
  std::vector<std::array<int, 4>> cell_neighbours;   ///< opposite each vertex; -1 outside the box
  Eigen::Matrix3Xd cell_centres;                     ///< dual vertex: equal power to its vertices, m
  std::vector<int> cell_pore;

  // one entry a pore
  Eigen::Matrix3Xd pore_centres;        ///< m
  std::vector<FaceSet> pore_faces;  ///< bit f is set when the pore touches face f

  // one entry a facet; the facets of throat t are [throat_facets[t], throat_facets[t + 1]), those
  // inside merged pores come after the last throat
  std::vector<std::array<Vertex, 3>> facet_vertices;  ///< spheres first; normal by the right-hand
                                                      ///< rule points from cell 0 to cell 1
  std::vector<std::array<int, 2>> facet_cells;  ///< -1: an image of a cell

  // one entry a throat (throat_facets has one more)
  std::vector<std::array<int, 2>> throat_pores;
  Eigen::Matrix3Xd throat_offsets;  ///< 3 x T, or 3 x 0 without periodic axes: what is added to the
                                    ///< centre of the second pore to get its image at the throat, m
  std::vector<int> throat_facets;

  std::vector<int> hidden;  ///< spheres whose power cell is empty, by ids: no vertices of any cell

  int cells() const { return static_cast<int>(cell_vertices.size()); }
  int pores() const { return static_cast<int>(pore_faces.size()); }
  int facets() const { return static_cast<int>(facet_vertices.size()); }
  int throats() const { return static_cast<int>(throat_pores.size()); }

  Eigen::Vector3d throat_offset(int throat) const {
    return throat_offsets.cols() == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                      : Eigen::Vector3d(throat_offsets.col(throat));
  }
};

}  // namespace pfv
