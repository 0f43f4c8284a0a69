// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/throats.hpp"
#include "pfv/options.hpp"

#include <vector>

namespace pfv {

/// Flow rate of each throat for a unit pressure difference, q = c (p_i - p_j), m³/(Pa s).
struct Conductances {
  std::vector<double> value;
  int degenerate = 0;  ///< throats whose law needed one of the rules below
};

/// Conductances by the law that the user chose.
///
/// hydraulic_radius (Chareyre et al. 2012 eqs. 7-9): c = alpha A^f (phi / gamma)² / (mu L) with
/// alpha = 1/2.
/// effective_radius (eq. 10): c = 2 pi R^4 / (mu L), R = (r_eq + r_inscribed) / 4.
///
/// open_throat: c = g / L with two resistances in series, of the throat while spheres touch and of
/// the drag on the spheres once they part:
///   1 / g = 1 / g_touching + w / g_open,
///   g_touching = alpha A^f R² / mu,  g_open = S e R² / (k mu),
/// but at most g = 10 S 2^n S / mu (n slip walls: they mirror the facet), where
///   R = phi / (gamma_s + 2/3 gamma_w), of spheres and no-slip walls: a wall's area goes wholly to
///       the side throats of its pore, which hold two thirds of the fluid; phi and gamma_s are
///       without 0.8 of the lenses and caps that overlaps and walls hide;
///   e = phi / (S L / 3), the porosity of the domain;
///   k = the Kozeny constant of Kuwabara's cell for e, and of plates (3) for no-slip walls, their
///       square roots averaged with gamma as weight (drags of few spheres and of a wall add up);
///   w = mean of h / (h + 0.18) over the sides of the facet, h the gap over the sum of radii (over
///       the radius at a wall); a triangle's widest side is left out, a slip wall mirrors the
///       facet, a no-slip wall is a side with w = 0.
/// Limits: the hydraulic radius where spheres touch (w = 0); Stokes' drag on single spheres where
/// they are far apart (w = 1, k = 1 / (2 (1 - e))). All of it adds up, or is a mean, over the
/// pieces of a polygon. Fitted: 0.18 on SC, BCC and FCC at radius scales 0.95 to 0.7; 0.8 on
/// overlapping SC, BCC and dense beds. Not fitted: random beds, the nine-sphere cell, 24 and 36
/// spheres with either wall.
///
/// Rules where a law has no meaning, counted as degenerate: a throat whose discs cover it (A^f <=
/// 1e-12 S) is closed; one with phi <= 0 or gamma <= 0 takes the hydraulic radius of its two whole
/// pores (open_throat: their porosity too), and is closed where these have none either; R_h is at
/// most 100 sqrt(S), the effective radius 5 sqrt(S); a throat with less than 1e-14 of what either of its
/// pores conducts in all is closed.
Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres);

}  // namespace pfv
