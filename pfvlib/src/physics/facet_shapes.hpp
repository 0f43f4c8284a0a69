// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <array>

namespace pfv {

/// A facet between three spheres.
struct FacetShape {
  double area = 0.0;                                ///< m²
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit; zero for a facet without area
  std::array<double, 3> side{};                     ///< from corner k to the next one, m
  std::array<double, 3> angle{};                    ///< of the triangle at corner k
  std::array<double, 2> height{};  ///< of the facet over its pores' centres, outwards positive, m
  std::array<std::array<double, 2>, 3> solid_angle{};  ///< at corner k of the pyramid to either pore's
                                                       ///< centre, of the sign of its height (Van
                                                       ///< Oosterom & Strackee 1983, eq. 8)
};

/// Facets that are measured together.
constexpr int facet_batch = 32;

/// The shapes of `count` <= facet_batch facets without walls, `facets`, of the throats `throats`.
void measure_facets(const PoreNetwork& network, const Spheres& spheres, const int* facets,
                    const int* throats, int count, FacetShape* shapes);

}  // namespace pfv
