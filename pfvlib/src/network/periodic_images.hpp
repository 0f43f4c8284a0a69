// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

/// The spheres of a periodic cell and those of their images that stand within a margin around it.
struct Images {
  Spheres spheres;
  std::vector<int> original;  ///< the sphere that each is an image of
  double margin = 0.0;        ///< m
};

Images replicate(const Spheres& spheres, double margin);

/// How many periods a vertex of the network, which may be an image, stands away from its sphere. `vertices`: what the
/// vertices stand for.
Lattice::Shift periods_of(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices, Vertex vertex);

/// Cuts one period out of the network of all images: the pores whose centre is in the cell, their
/// cells, and each throat once, with the offset of its second pore's image. Pores are matched by
/// place, not by their cells, since the images of a cospherical set may be triangulated in different
/// ways. Returns false when the margin was too small for the triangulation to be that of the infinite
/// packing.
bool fold(const PoreNetwork& all, const Images& images, const Spheres& spheres, double spacing,
          PoreNetwork& network);

}  // namespace pfv
