// SPDX-License-Identifier: GPL-3.0-or-later
// Would conductances that are refreshed on the old graph pay, between two triangulations?
//   pfv_refresh_bench [SPHERES]     pfv_refresh_bench cells: how many cells a move changes
// A packing is compressed, each sphere also in a way of its own. For the moved spheres: the network as it
// was, the same cells measured anew (centres, throats, conductances, S; numeric factor on the kept ordering),
// and a new network. Errors beside the new network: flow rate and forces under a pressure difference.
#include "network/grains.hpp"
#include "work/phase_clock.hpp"
#include "network/cell_centres.hpp"
#include "network/pore_boundaries.hpp"
#include "network/pore_network.hpp"
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "physics/conductances.hpp"
#include "physics/force_matrix.hpp"
#include "physics/throats.hpp"
#include "solve/pressure_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace pfv;

Box through_flow() {
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::pressure(1.0);
  return box;
}

Spheres spheres_of(const PackingArrays& packing, const Box& box) {
  return select_grains(packing.view(), box, OutsideGrains::refuse).spheres;
}

/// A network and what it gives.
struct Solved {
  PoreNetwork network;
  std::shared_ptr<LinearSolver> solver;
  double seconds = 0.0, rate = 0.0;
  Eigen::Matrix3Xd forces;
  std::vector<double> volumes;  ///< of the pores, with the spheres' parts
};

/// All that follows from `network`; the ordering of `kept` where there is one.
void finish(Solved& result, const Spheres& spheres, const Box& box,
            const std::shared_ptr<LinearSolver>& kept) {
  const PoreNetwork& network = result.network;
  const PoreBoundaries boundaries = find_pore_boundaries(network, box);
  const Throats throats = measure_throats(network, boundaries, spheres);
  result.volumes = throats.pore_volume;
  const ConductanceLaw law = Options{}.conductance;
  const std::vector<double> conductance =
      conductances(law, 1.0, network, throats, spheres).value;
  const Unknowns unknowns = number_unknowns(network, boundaries, box);
  const PressureSystem system = assemble(network, conductance, unknowns, {});
  result.solver = kept;
  if (!kept) {
    Eigen::Matrix3Xd places(3, unknowns.count);
    for (int p = 0; p < network.pores(); ++p)
      if (unknowns.of_pore[p] >= 0) places.col(unknowns.of_pore[p]) = network.pore_centres.col(p);
    result.solver = make_solver(SolverKind::automatic, OrderingKind::automatic);
    result.solver->order(system.matrix, places);
  }
  result.solver->factor(system.matrix);
  const ForceMatrix forces =
      force_matrix(network, spheres, throats, viscous_shares(law, network, throats, spheres),
                   spheres.size(), {});
  Eigen::VectorXd pressures(network.pores()), b, x = Eigen::VectorXd::Zero(unknowns.count);
  impose_pressures(network, boundaries, box, 0.0, pressures);
  right_hand_side(system, unknowns, box, Eigen::VectorXd::Zero(network.pores()), pressures, b);
  result.solver->solve(b, x);
  for (int p = 0; p < network.pores(); ++p)
    if (unknowns.of_pore[p] >= 0) pressures[p] = x[unknowns.of_pore[p]];
  result.forces = multiply(forces, pressures).topLeftCorner(3, spheres.size());
  result.rate = 0.0;
  for (const auto& coupling : system.couplings)
    if (network.pore_faces[coupling.pore] >> static_cast<int>(Face::zhi) & 1)
      result.rate += coupling.conductance * (1.0 - x[coupling.unknown]);
}

Solved built(const Spheres& spheres, const Box& box) {
  Solved result;
  const double start = cpu_seconds();
  result.network = build_network(spheres, box.lower).network;
  finish(result, spheres, box, nullptr);
  result.seconds = cpu_seconds() - start;
  return result;
}

Solved refreshed(const Solved& old, const Spheres& spheres, const Box& box) {
  Solved result;
  const double start = cpu_seconds();
  result.network = old.network;
  PoreNetwork& network = result.network;
  network.cell_centres =
      cell_centres({network.cell_vertices, network.cell_neighbours, {}}, spheres).places;
  for (int cell = 0; cell < network.cells(); ++cell)
    network.pore_centres.col(network.cell_pore[cell]) = network.cell_centres.col(cell);
  finish(result, spheres, box, old.solver);
  result.seconds = cpu_seconds() - start;
  return result;
}

/// StrainMeasure::mean, with the same spheres in the pores.
double mean_strain(const Solved& old, const Solved& now, const PackingArrays& packing) {
  double changes = 0.0, volume = 0.0;
  for (std::size_t p = 0; p < old.volumes.size(); ++p) {
    changes += std::abs(now.volumes[p] - old.volumes[p]);
    volume += old.volumes[p];
  }
  return 100.0 * changes / (volume - 4.0 / 3.0 * M_PI * packing.radii.array().cube().sum());
}

double difference(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return 100.0 * (a - b).norm() / b.norm();
}

}  // namespace

namespace {

PackingArrays moved_packing(const PackingArrays& first, double strain, Box& box) {
  const double radius = first.radii.mean();
  PackingArrays moved = first;
  std::minstd_rand random(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index k = 0; k < moved.positions.cols(); ++k)
    for (int axis = 0; axis < 3; ++axis) moved.positions(axis, k) += strain * radius * normal(random);
  moved.positions = moved.positions.cwiseMax(1e-3 * radius).cwiseMin(1.0 - 1e-3 * radius);
  moved.positions.row(2) *= 1.0 - strain;
  box.upper[2] *= 1.0 - strain;
  return moved;
}

std::vector<std::array<int, 4>> named_cells(const PackingArrays& packing, const Box& box) {
  PoreNetwork network = build_network(spheres_of(packing, box), box.lower).network;
  for (auto& cell : network.cell_vertices) std::sort(cell.begin(), cell.end());
  std::sort(network.cell_vertices.begin(), network.cell_vertices.end());
  return network.cell_vertices;
}

/// Part of the cells of a moved packing that its network did not have before: none where the graph
/// stays, and with it the symbolic factor.
void print_new_cells() {
  std::printf("| spheres |");
  const std::vector<double> strains{1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  for (const double strain : strains) std::printf(" %g %% |", 100.0 * strain);
  std::printf("\n|--|--|--|--|--|--|\n");
  for (const int count : {300, 1000, 5000}) {
    const PackingArrays first = dense_packing(count);
    const Box still = through_flow();
    const auto before = named_cells(first, still);
    std::printf("| %d |", count);
    for (const double strain : strains) {
      Box box = still;
      const auto now = named_cells(moved_packing(first, strain, box), box);
      std::vector<std::array<int, 4>> created;
      std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                          std::back_inserter(created));
      std::printf(" %zu of %zu |", created.size(), now.size());
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "cells") {
    print_new_cells();
    return 0;
  }
  const int count = argc > 1 ? std::atoi(argv[1]) : 5000;
  const PackingArrays first = dense_packing(count);
  std::printf("%d spheres\n\n| compression | mean pore strain | flow rate, error: old | refreshed | forces, rms error: old | "
              "refreshed | refresh / rebuild, CPU |\n|--|--|--|--|--|--|--|\n", count);
  for (const double strain : {1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2}) {
    Box box = through_flow();
    const Solved old = built(spheres_of(first, box), box);
    const PackingArrays moved = moved_packing(first, strain, box);
    const Spheres spheres = spheres_of(moved, box);
    const Solved now = built(spheres, box), again = refreshed(old, spheres, box);
    const auto rate = [&](const Solved& other) { return 100.0 * (other.rate / now.rate - 1.0); };
    std::printf("| %g %% | %.3g %% | %.3f %% | %.3f %% | %.3f %% | %.3f %% | %.2f |\n", 100.0 * strain,
                mean_strain(old, again, first), rate(old), rate(again), difference(old.forces, now.forces),
                difference(again.forces, now.forces), again.seconds / now.seconds);
    std::fflush(stdout);
  }
}
