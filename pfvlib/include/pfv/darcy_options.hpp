// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/fluid.hpp"
#include "pfv/names.hpp"
#include "pfv/options.hpp"

#include <array>

namespace pfv {

/// Drag of the fluid on a grain of a coarse cell. `di_felice`: the drag of a single sphere times a
/// power of the porosity, as in the CFD module that the Darcy example of PFC uses. `kozeny_carman`:
/// what the flow itself resists, shared among the grains by volume, so that fluid and grains
/// exchange exactly the same momentum.
enum class DragLaw { di_felice, kozeny_carman };
template <>
struct Names<DragLaw> {
  static constexpr const char* what = "drag law";
  static constexpr std::array<Named<DragLaw>, 2> all{
      {{DragLaw::di_felice, "di_felice"}, {DragLaw::kozeny_carman, "kozeny_carman"}}};
};

struct DarcyOptions {
  std::array<int, 3> cells{1, 1, 1};  ///< along x, y, z; > 0. Two grain diameters a cell or more
  int refresh_every = 1;              ///< steps between two renewals of the porosity, > 0
  DragLaw drag = DragLaw::di_felice;
  /// The grains carry fluid with them and displace it. false: a steady flow through grains at rest,
  /// in which they move, as in the example.
  bool grain_motion = true;
};

/// Throws InputError for numbers of cells or steps < 1, and for what a grid cannot use: a
/// bulk modulus, options that shape a pore network.
void check(const DarcyOptions& grid, const Fluid& fluid, const Options& options);

}  // namespace pfv
