// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/network.hpp"

#include <array>
#include <vector>

namespace pfv {

/// Kites of one sphere on edges that run beside each other, where planes meet at obtuse angles. They are one throat
/// that the planes cut into pieces of any size and sign (a piece is turned over where a foot lies beyond its edge):
/// what a piece has of fluid and of surface means nothing, only all together say what they conduct.
struct KiteRow {
  std::vector<int> throats;
  int sphere = -1;
  std::array<Vertex, 2> ends{0, 0};  ///< the walls with one kite only; 0: the row is closed
};

/// The rows of all spheres with more than one kite.
struct KiteRows {
  std::vector<KiteRow> rows;
  std::vector<int> row;       ///< of each throat, -1: none; empty where no planes meet at obtuse angles
  std::vector<double> share;  ///< of each throat in what its row conducts: by the angles between its walls

  const KiteRow* of(int t) const { return row.empty() || row[t] < 0 ? nullptr : &rows[row[t]]; }
};

/// Pure. Cost: that of the facets at two walls.
KiteRows find_kite_rows(const PoreNetwork& network, const Spheres& spheres);

}  // namespace pfv
