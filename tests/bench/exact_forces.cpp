// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of a flow along z through a dense packing of the unit cube, solved in extended precision (64 bits of mantissa on
// x86), as CSV: what doc/error_vs_time.py measures solvers by.  pfv_exact_forces SPHERES [SEED]
#include "pfv/dense_packing.hpp"
#include "support/motions.hpp"
#include "support/stages.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace {

using namespace pfv;
using Extended = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// b - A x.
Extended residual_of(const SymmetricMatrix& matrix, const Eigen::VectorXd& b, const Extended& x) {
  Extended residual = b.cast<long double>();
  for (int row = 0; row < matrix.size(); ++row)
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k)
      residual[row] -= static_cast<long double>(matrix.value[k]) * x[matrix.column[k]];
  return residual;
}

/// By the direct solver and refinement, until the residual is that of the last bit or falls no more.
Extended solution_of(const SymmetricMatrix& matrix, const Eigen::VectorXd& b) {
  const auto solver = make_solver(SolverKind::automatic, OrderingKind::automatic);
  solver->order(matrix);
  solver->factor(matrix);
  Extended x = Extended::Zero(b.size());
  long double before = std::numeric_limits<long double>::infinity();
  for (int turn = 0; turn < 20; ++turn) {
    const Extended residual = residual_of(matrix, b, x);
    if (!(residual.norm() < 0.5L * before)) break;
    before = residual.norm();
    Eigen::VectorXd correction;
    solver->solve(residual.cast<double>(), correction);
    x += correction.cast<long double>();
  }
  std::fprintf(stderr, "residual %.1Le of the right-hand side\n", before / static_cast<long double>(b.norm()));
  return x;
}

Extended pressures_of(const support::Stages& stages, const std::vector<double>& conductances) {
  const Unknowns unknowns = number_unknowns(stages.network, stages.boundaries, stages.box);
  const PressureSystem system = assemble(stages.network, conductances, unknowns, {});
  Eigen::VectorXd imposed = Eigen::VectorXd::Zero(stages.network.pores()), b;
  impose_pressures(stages.network, stages.boundaries, stages.box, 0.0, imposed);
  right_hand_side(system, unknowns, stages.box, Eigen::VectorXd::Zero(stages.network.pores()), imposed, b);
  const Extended found = solution_of(system.matrix, b);
  Extended pressures = imposed.cast<long double>();
  for (int pore = 0; pore < stages.network.pores(); ++pore)
    if (const int unknown = unknowns.of_pore[pore]; unknown >= 0) pressures[pore] = found[unknown];
  return pressures;
}

}  // namespace

int main(int argc, char** argv) {
  const int spheres = argc > 1 ? std::atoi(argv[1]) : 0;
  if (spheres < 1) {
    std::fprintf(stderr, "usage: pfv_exact_forces SPHERES [SEED]\n");
    return 2;
  }
  const PackingArrays packing = dense_packing(spheres, 0.6, 0.2, static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1));
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::pressure(1.0);
  const support::Stages stages = support::stages_of(packing, box);
  const Conductances conductance = conductances(ConductanceLaw::open_throat, 1.0, stages.network, stages.throats, stages.spheres);
  const Extended pressures = pressures_of(stages, conductance.value);
  const ForceMatrix forces = support::force_matrix_of(stages);
  std::printf("id,fx,fy,fz\n");
  for (int sphere = 0; sphere < spheres; ++sphere) {
    Eigen::Matrix<long double, 3, 1> force = Eigen::Matrix<long double, 3, 1>::Zero();
    for (int k = forces.row_begin[sphere]; k < forces.row_begin[sphere + 1]; ++k)
      force += forces.value.col(k).head<3>().cast<long double>() * pressures[forces.pore[k]];
    std::printf("%lld,%.20Lg,%.20Lg,%.20Lg\n", static_cast<long long>(packing.ids[sphere]), force[0], force[1], force[2]);
  }
}
