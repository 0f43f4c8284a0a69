// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/throats.hpp"
#include "pfv/options.hpp"

#include <vector>

namespace pfv {

/// Flow rate of each throat for a unit pressure difference, q = c (p_i - p_j), m³/(Pa s).
struct Conductances {
  std::vector<double> value;
  std::vector<char> by_rule;  ///< degenerate: the law needed one of the rules below
};

/// Conductances by the law that the user chose.
///
/// hydraulic_radius (Chareyre et al. 2012 eqs. 7-9): c = alpha A^f (phi / gamma)² / (mu L) with
/// alpha = 1/2.
/// effective_radius (eq. 10): c = 2 pi R^4 / (mu L), R = (r_eq + r_inscribed) / 4.
///
/// open_throat: physics/open_throat.hpp.
///
/// Rules where a law has no meaning, counted as degenerate: a throat whose discs cover it (A^f <=
/// 1e-12 S) is closed; one with phi <= 0 or gamma <= 0 takes the hydraulic radius of its two whole
/// pores (open_throat: their porosity too), and is closed where these have none either; R_h is at
/// most 100 sqrt(S), the effective radius 5 sqrt(S); a throat with less than 1e-14 of what either of its
/// pores conducts in all is closed.
Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres, Team& team);
Conductances conductances(ConductanceLaw law, double viscosity, const PoreNetwork& network,
                          const Throats& throats, const Spheres& spheres);

/// Such a throat is closed whatever the law.
bool is_closed(const Throats& throats, int t);

}  // namespace pfv
