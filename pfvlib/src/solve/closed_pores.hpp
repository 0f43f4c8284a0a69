// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "parallel/share.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"
#include "solve/pressure_system.hpp"
#include "solve/row_share.hpp"

#include <vector>

namespace pfv {

/// The pores that the overlaps of rigid bodies close. Spheres of one body overlap by design, so that what lies
/// within it is no fluid; what they close off beside a neighbour is fluid that a rough contact would let out.
struct ClosedPores {
  int enclosed = 0;  ///< within one body: without an unknown, at the reference pressure, of no volume that changes
  int joined = 0;    ///< cut off otherwise, at a body: they share the unknown of the pore behind their widest facet
};

/// Renumbers the unknowns and closes the throats of enclosed pores. `bodies`: of each sphere, -1 for none; a sphere whose
/// centre is within one of a body's counts as part of it here. Of several ranks
/// (`rows`: as the unknowns are before) each comes to know the ways out of all that is cut off, some 0.1 kB each.
/// Collective there.
ClosedPores take_out_closed_pores(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                                  const std::vector<int>& bodies, const Share& share, const RowShare* rows,
                                  std::vector<double>& conductances, Unknowns& unknowns);

}  // namespace pfv
