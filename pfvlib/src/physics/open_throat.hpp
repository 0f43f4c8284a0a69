// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/throats.hpp"

namespace pfv {

/// A throat by the open-throat law.
struct OpenThroat {
  double value = 0.0;         ///< mu g = mu c L, m⁴; 0 where neither it nor its pores have an R
  double drag_share = 0.0;    ///< of the drag in its resistance: 0 where spheres touch, 1 far apart
  double wall_share = 0.0;    ///< of no-slip walls in its solid surface
  double hidden_share = 0.0;  ///< of its solid surface that overlaps hide
  bool by_rule = false;       ///< phi or gamma <= 0
  bool at_bound = false;      ///< g is the largest that the law allows
};

/// c = g / L with two resistances in series, of the throat while spheres touch and of the drag on
/// the spheres once they part:
///   1 / g = 1 / g_touching + w / g_open,
///   g_touching = alpha A^f R² / mu,  g_open = S e R² / (k mu),
/// but at most g = 1000 S 2^n S / mu (n slip walls: they mirror the facet), where
///   R = phi / (gamma_s + 2/3 gamma_w), of spheres and no-slip walls: a wall's area goes wholly to
///       the side throats of its pore, which hold two thirds of the fluid; phi and gamma_s are
///       without the lenses and caps that overlaps hide, and 0.8 of the caps beyond walls;
///   e = phi / (S L / 3), the porosity of the domain; at a round wall over the domain's own volume;
///   k = the Kozeny constant of Kuwabara's cell for e, and of plates (3) for no-slip walls, their
///       square roots averaged with gamma as weight (drags of few spheres and of a wall add up);
///   w = mean of q / (1 + q) over the sides of the facet, q = (h / 0.18)^0.8, h the gap over the
///       sum of radii (over the radius at a wall), even below h = 0.001; a triangle's widest side
///       is left out, a slip wall mirrors the facet, a no-slip wall is a side with w = 0.
/// Limits: the hydraulic radius where spheres touch (w = 0); Stokes' drag on single spheres where
/// they are far apart (w = 1, k = 1 / (2 (1 - e))). All of it adds up, or is a mean, over the
/// pieces of a polygon, and over a row of kites, of which each throat gets its share. Fitted: 0.18 and its power on
/// SC, BCC and FCC at radius scales 0.95 to 0.7;
/// the share of caps on two dense beds. Not fitted: overlapping lattices, random beds, the
/// nine-sphere cell, 24 and 36 spheres with either wall.
///
/// For throats that are not closed. Pure; about 1 µs.
OpenThroat open_throat(const PoreNetwork& network, const Throats& throats, const Spheres& spheres,
                       int t);

}  // namespace pfv
