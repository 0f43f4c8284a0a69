// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/pore_boundaries.hpp"
#include "parallel/share.hpp"
#include "pfv/container.hpp"
#include "pfv/network.hpp"
#include "solve/linear_solver.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace pfv {

/// What decides a pore's pressure.
struct Unknowns {
  static constexpr int imposed = -1;
  std::vector<int> of_pore;      ///< its unknown, or `imposed`
  std::vector<int> of_boundary;  ///< the unknown that the pores of a flux boundary share, or -1
  std::vector<int> fed_by;       ///< of a boundary with such an unknown, the pore where its flux counts; -1 on other ranks
  std::vector<int> imposed_pores;  ///< those of imposed pressure
  std::vector<int> enclosed_pores;  ///< within rigid bodies: neither (solve/closed_pores.hpp)
  /// One that pores share on whatever ranks they are: who has its row, and what all know it by.
  struct Shared {
    int unknown, owner;
    std::int64_t name;
  };
  std::vector<Shared> shared;
  int count = 0;
};

/// 1 for each boundary whose shared pressure pores have, on whatever rank, 0 for the others. Collective.
Eigen::VectorXd flux_boundaries_reached(const Unknowns& unknowns, const Share& share);

/// Numbers the unknowns. A pore on several faces takes the first of: imposed pressure, imposed flux
/// (the first face), none. Throws InputError for a flux boundary that is left without a pore.
Unknowns number_unknowns(const PoreNetwork& network, const PoreBoundaries& boundaries,
                         const Container& container, const Share& share = {});

/// Sets the pressure (Pa) of each pore with an imposed one, and no other: the mean over its boundaries
/// with a pressure.
void impose_pressures(const PoreNetwork& network, const PoreBoundaries& boundaries, const Container& container,
                      double time, Eigen::VectorXd& pressures);

/// A set of pores that no open throat joins to an imposed pressure.
struct Isolated {
  std::vector<int> pores;
  int unknown;  ///< the one that is held at the reference pressure; -1: one of another rank
  double pin;   ///< what holds it: added to its diagonal
  bool main = false;  ///< the fluid itself, where no pressure is imposed: not trapped
};

/// Those that there are; nothing pinned yet.
std::vector<Isolated> find_isolated(const PoreNetwork& network, const std::vector<double>& conductances,
                                    const Unknowns& unknowns);

/// G p = b (Chareyre et al. 2012 eq. 6; thesis eq. 4.8) for the unknown pressures.
struct PressureSystem {
  SymmetricMatrix matrix;
  struct Coupling {
    int unknown, pore;  ///< a pore of imposed pressure beside an unknown one
    double conductance;
  };
  std::vector<Coupling> couplings;
  std::vector<Isolated> isolated;
};

struct RowShare;

/// Assembles G of G p = b (eq. 6; thesis eq. 4.8). `storage` (m³/Pa, one entry a pore, or none) is V^f / (K_f dt) of a
/// compressible fluid; it goes on the diagonal and leaves nothing isolated. On several ranks (`rows`) the rows of own
/// unknowns; those of borders hold what own pores give.
PressureSystem assemble(const PoreNetwork& network, const std::vector<double>& conductances,
                        const Unknowns& unknowns, const std::optional<Eigen::VectorXd>& storage, const Share& share = {},
                        const RowShare* rows = nullptr);

/// b of G p = b: -dV/dt and other sources of each pore (m³/s) + Q, the inflow of the flux boundaries + what the imposed
/// pressures (relative to the reference; read at their pores alone) drive.
void right_hand_side(const PressureSystem& system, const Unknowns& unknowns, const Container& container,
                     const Eigen::VectorXd& sources, const Eigen::VectorXd& imposed,
                     Eigen::VectorXd& b);

}  // namespace pfv
