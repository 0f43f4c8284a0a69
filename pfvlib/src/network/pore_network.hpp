// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/cell_centres.hpp"
#include "network/spheres.hpp"
#include "network/triangulation.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

/// A triangulation with its dual vertices.
struct Cells {
  Triangulation triangulation;
  CellCentres centres;
};
Cells find_cells(const Spheres& spheres);

/// For each cell the first of those that are one pore with it. `spacing`: mean distance of the spheres, m.
std::vector<int> first_cells(const Cells& cells, const Spheres& spheres, double spacing);

/// The pores and throats that cells make. Cells may be missing beside others: no throat leads there.
PoreNetwork network_of(Cells&& cells, const Spheres& spheres, double spacing);

/// The network and the spheres that its vertices stand for: the packing's own or, with periodic axes,
/// those and their images.
struct PoreSpace {
  PoreNetwork network;
  Spheres spheres;
};

/// Packing and box -> pores and throats (Chareyre et al. 2012, sec. 2). Cells that share one dual
/// vertex (distance below 1e-6 of the mean sphere spacing) become one pore, and flat cells join a
/// neighbour, so that a lattice and the same lattice displaced by rounding give the same network.
/// Throws InputError when two spheres have one centre. With periodic axes the cost is that of the
/// packing with a margin of some three spheres around it.
PoreSpace build_network(const Spheres& spheres, const Eigen::Vector3d& origin);

/// The cell that contains a place (in the coordinates of `spheres`): walks from cell `start` through
/// the facets that separate. -1 where the walk leaves the network, as into an image, or runs in a circle. Cost: about
/// N^(1/3) steps.
int walk_to(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place, int start);

/// The same; where the walk comes to nothing, the cell outside which the place is least, of all.
int locate(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place,
           int start);

/// How far a place lies outside a cell, m; <= 0 inside.
double distance_outside(const PoreNetwork& network, const Spheres& spheres, const Eigen::Vector3d& place, int cell);

}  // namespace pfv
