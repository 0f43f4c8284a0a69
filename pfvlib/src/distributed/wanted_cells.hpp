// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"
#include "network/pore_network.hpp"

#include <algorithm>
#include <vector>

namespace pfv {

// Which cells of a local triangulation a rank keeps, and what it has to ask others for before it knows that they are
// those of all grains.

/// Which cells this rank keeps.
struct Wanted {
  std::vector<char> cells;
  std::vector<char> whole_cells;    ///< of these, those whose pores have all their throats
  std::vector<char> whole_spheres;  ///< own ones and those of pores with one
};

/// Own pores, all that stands around their spheres, and one layer of cells more. `first`: of each cell the first one of
/// its pore; `is_own`: one entry a sphere.
Wanted wanted_cells(const Triangulation& triangulation, const std::vector<int>& first, const std::vector<char>& is_own);

/// The ball within which a cell's grains are those of least power: none reaches into it, if the cell is one of all
/// grains.
Halo::Query ball_of(const Cells& cells, std::size_t cell, const Spheres& spheres, double largest_radius);
/// How far the centre of a grain that reaches into the ball may be from its own, m.
double reach_of(const Halo::Query& ball, double largest_radius);

/// Cells without those that are not wanted; spheres by their new numbers, -1 for none.
Cells kept_cells(const Cells& all, const std::vector<char>& wanted, const std::vector<int>& new_vertex);

/// Which active grains are this rank's.
std::vector<char> own_spheres(const ActiveGrains& grains, const Halo& halo);
/// Drops ghosts that are not used, from the halo and the active grains; returns the new number of each sphere, -1 for
/// none. `used`: one entry a sphere. Collective.
std::vector<int> keep_spheres(const std::vector<char>& used, Halo& halo, const Container& container, ActiveGrains& grains);

}  // namespace pfv
