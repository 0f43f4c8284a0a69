// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"
#include "physics/facet_shapes.hpp"

#include <Eigen/Core>
#include <array>

namespace pfv {

/// A^k: the part of a facet that disc k covers and that lies on its side of the chords it shares with the
/// other discs, so that the parts add up to the area of the discs' union.
struct DiscPart {
  double area = 0.0;                                  ///< m²
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< area times (centroid - centre of sphere k), m³
};

/// For any facet; `normal` is its unit normal, `area` its area.
DiscPart disc_part(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                   const Eigen::Vector3d& normal, double area);

/// The area alone in a triangle, where the disc meets no other side and the chords it shares with other
/// discs do not meet within it: a sector less what lies beyond each chord. Else a negative number.
double disc_part_of_triangle(const std::array<Vertex, 3>& facet, int corner,
                             const Spheres& spheres, const FacetShape& shape);

/// The moment of `disc_part` alone, by the same shortest way; what S needs of each facet.
Eigen::Vector3d disc_moment(const std::array<Vertex, 3>& facet, int corner, const Spheres& spheres,
                            const Eigen::Vector3d& normal, double area);

}  // namespace pfv
