// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <vector>

namespace pfv {

/// A sphere's image, so many periods away.
struct SphereImage {
  int sphere;
  Lattice::Shift shift;
};

/// The spheres of a periodic cell and those of their images that stand within a margin around it.
struct Images {
  Spheres spheres;
  std::vector<int> original;  ///< the sphere that each is an image of
  double margin = 0.0;        ///< m
};

/// Those within a margin around the cell, in the order of their shifts.
std::vector<SphereImage> images_within(const Spheres& spheres, double margin);
Images replicate(const Spheres& spheres, double margin);
/// Those of a list; no margin.
Images images_of(const Spheres& spheres, const std::vector<SphereImage>& list);

/// How far around a cell images are needed at least, m.
inline double least_margin(double spacing, double largest_radius) { return 2.5 * spacing + 2.0 * largest_radius; }
/// Throws InputError for a cell that needs images without number: from the beginning, or since its pores come out
/// otherwise in each image. `spheres`: how many; `reach`: how far around the cell their images go, that margin or farther;
/// `first`: no margin has been tried.
void refuse_endless_images(const Lattice& lattice, double spheres, double largest_radius, double margin, double reach,
                           bool first);

/// How many periods a vertex of the network, which may be an image, stands away from its sphere. `vertices`: what the
/// vertices stand for.
Lattice::Shift periods_of(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices, Vertex vertex);

/// Periods that a place is away from the cell; what stands on the cell's upper border but for rounding is below.
Lattice::Shift shift_of(const Eigen::Vector3d& place, const Spheres& spheres);

/// Cuts one period out of the network of all images: the pores whose centre is in the cell, their
/// cells, and each throat once, with the offset of its second pore's image. Pores are matched by
/// place, not by their cells, since the images of a cospherical set may be triangulated in different
/// ways. Returns false when the margin was too small for the triangulation to be that of the infinite
/// packing.
bool fold(const PoreNetwork& all, const Images& images, const Spheres& spheres, double spacing,
          PoreNetwork& network);

/// The same of the part of it that one of several ranks has: the pores of `all` in the period, in the order of all of
/// them, with the images of those that are whole. `whole_pores`: one entry a pore of `all`; of one that is not whole, throats
/// may be missing. `whole` becomes those of the network. Returns false also where an image is not there; which cells hold
/// is for the caller to know.
bool fold_part(const PoreNetwork& all, const Images& images, const Spheres& spheres, double spacing,
               const std::vector<char>& whole_pores, PoreNetwork& network, std::vector<char>& whole);

}  // namespace pfv
