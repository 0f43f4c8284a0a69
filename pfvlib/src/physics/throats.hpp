// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "network/spheres.hpp"
#include "parallel/team.hpp"
#include "pfv/network.hpp"
#include "physics/kite_rows.hpp"

#include <array>
#include <vector>

namespace pfv {

/// Geometry of facets and throats (Chareyre et al. 2012, sec. 3.2). The domain of a throat between
/// pores i and j is the union of the pyramids (facet, P_i) and (facet, P_j) minus the spheres;
/// volumes and solid angles are signed, since P may lie beyond its facet.
struct Throats {
  // one entry a facet of the network; k counts its vertices (spheres first)
  std::vector<std::array<double, 3>> facet_disc;   ///< A^k: part of disc k in the facet, m²; discs
                                                   ///< that overlap are parted by their chord
  std::vector<std::array<double, 3>> facet_gamma;  ///< area of sphere k in the domain, or of wall k
                                                   ///< if it is a no-slip wall, m²

  // one entry a throat
  Eigen::Matrix3Xd normal;           ///< from its first pore to its second: the mean over its pieces,
                                     ///< shorter than 1 where nearly coincident spheres fold them,
                                     ///< so that forces balance there too
  std::vector<double> area;          ///< S: polygon, m²
  std::vector<double> fluid_area;    ///< A^f = S - sum of A^k, >= 0, m²
  std::vector<double> length;        ///< L = |P_i P_j|, m
  std::vector<double> volume;        ///< phi, pore volume of the domain, m³
  std::vector<double> gamma;         ///< solid surface of the domain, no-slip walls included, m²
  /// Of a throat at a round wall: its domain with the spheres in it, m³, which is no bipyramid of volume S L / 3; 0 for
  /// other throats; empty without such a wall.
  std::vector<double> round_domain;
  std::vector<double> conductance_factor;  ///< empty, or what the law's result is multiplied with
  KiteRows kite_rows;                ///< those that conduct as one

  // one entry a pore
  std::vector<double> pore_volume;        ///< of its cells, solid included, m³
  std::vector<double> pore_fluid_volume;  ///< minus the wedges of its spheres, m³
  std::vector<double> pore_gamma;         ///< solid surface in its cells, m²
};

/// Shape factor of g = alpha A^f R_h² / mu: Chareyre et al. 2012, after eq. 9.
inline constexpr double alpha = 0.5;

/// Volume of a throat's domain with the spheres in it, m³.
inline double domain_of(const Throats& throats, int t) {
  const bool round = !throats.round_domain.empty() && throats.round_domain[t] > 0.0;
  return round ? throats.round_domain[t] : throats.area[t] * throats.length[t] / 3.0;
}

/// R_h of two whole pores, m; 0 where they have no solid surface.
double hydraulic_radius_of_pores(const Throats& throats, const std::array<int, 2>& pores);

/// phi, gamma and gamma^k, A^k, A^f, S, L and n of every throat (Chareyre et al. 2012, sec. 3.2, as far as eqs. 9, 14
/// and 18 take them). Pure; cost about 3 µs a sphere. No byte depends on the team.
Throats measure_throats(const PoreNetwork& network, const PoreBoundaries& boundaries,
                        const Spheres& spheres, Team& team);
Throats measure_throats(const PoreNetwork& network, const PoreBoundaries& boundaries,
                        const Spheres& spheres);

}  // namespace pfv
