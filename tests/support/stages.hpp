// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/grains.hpp"
#include "network/pore_boundaries.hpp"
#include "network/pore_network.hpp"
#include "physics/conductances.hpp"
#include "physics/throats.hpp"
#include "pfv/container.hpp"
#include "pfv/packing.hpp"
#include "solve/linear_solver.hpp"
#include "solve/pressure_system.hpp"

#include <Eigen/Core>
#include <vector>

namespace support {

/// Every stage up to the throats, for tests that look inside.
struct Stages {
  pfv::Container box;
  pfv::Spheres spheres;
  pfv::PoreNetwork network;
  pfv::PoreBoundaries boundaries;
  pfv::Throats throats;
};

inline Stages stages_of(const pfv::PackingArrays& packing, const pfv::Container& box) {
  Stages s;
  s.box = box;
  s.spheres = pfv::select_grains(packing.view(), box, pfv::OutsideGrains::refuse).spheres;
  s.network = pfv::build_network(s.spheres, box.lower).network;
  s.boundaries = pfv::find_pore_boundaries(s.network, box);
  s.throats = pfv::measure_throats(s.network, s.boundaries, s.spheres);
  return s;
}

/// Incompressible pore pressures for given conductances and dV/dt of each pore.
inline Eigen::VectorXd pressures_of(const Stages& s, const std::vector<double>& conductances,
                                    const Eigen::VectorXd& rates) {
  const pfv::Unknowns unknowns = pfv::number_unknowns(s.network, s.boundaries, s.box);
  const pfv::PressureSystem system = pfv::assemble(s.network, conductances, unknowns, {});
  Eigen::VectorXd pressures(s.network.pores()), b;
  pfv::impose_pressures(s.network, s.boundaries, s.box, 0.0, pressures);
  pfv::right_hand_side(system, unknowns, s.box, -rates, pressures, b);
  Eigen::VectorXd solution(unknowns.count);
  const auto solver = pfv::make_solver(pfv::SolverKind::automatic, pfv::OrderingKind::automatic);
  solver->order(system.matrix);
  solver->factor(system.matrix);
  solver->solve(b, solution);
  for (int p = 0; p < s.network.pores(); ++p)
    if (unknowns.of_pore[p] >= 0) pressures[p] = solution[unknowns.of_pore[p]];
  return pressures;
}

/// Flow rate out of the pores of `face` into the others, m³/s.
inline double rate_from(const Stages& s, pfv::Face face, const std::vector<double>& conductances,
                        const Eigen::VectorXd& pressures) {
  double rate = 0.0;
  const auto on = [&](int pore) {
    return s.network.pore_faces[pore] >> static_cast<int>(face) & 1;
  };
  for (int t = 0; t < s.network.throats(); ++t) {
    const auto [i, j] = s.network.throat_pores[t];
    if (on(i) == on(j)) continue;
    const double q = conductances[t] * (pressures[i] - pressures[j]);
    rate += on(i) ? q : -q;
  }
  return rate;
}

}  // namespace support
