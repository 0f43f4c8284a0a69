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
/// hydraulic_radius (Chareyre et al. 2012 eqs. 7-9): c = alpha A^f (phi / gamma)² / (mu L), alpha = 1/2.
/// effective_radius (eq. 10): c = 2 pi R^4 / (mu L), R = (r_eq + r_inscribed) / 4.
///
/// Rules where a law has no meaning, counted as degenerate: a throat whose discs cover it
/// (A^f <= 1e-12 S) is closed; one with phi <= 0 or gamma <= 0 takes the hydraulic radius of its two
/// whole pores, and is closed where these have none either.
Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres);

}  // namespace pfv
