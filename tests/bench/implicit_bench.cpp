// SPDX-License-Identifier: GPL-3.0-or-later
// What an implicit step's matrix costs beside that of an explicit one, G, on dense packings, one thread:
//   pfv_implicit_bench [SPHERES...]
// K: pressures and velocities together, as implicit steps have them (solve/implicit_system.hpp); A = G + S^T B S:
// with the velocities eliminated before the matrix is made.
// Both give the same pressures; `differ` is by how much, over the largest. Lines: spheres, matrix and ordering, unknowns,
// entries of a row, entries of the factor (millions), CPU ms to assemble, order, factor and solve, `differ`.
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "physics/force_matrix.hpp"
#include "physics/volume_rates.hpp"
#include "solve/fill_reducing_ordering.hpp"
#include "solve/implicit_system.hpp"
#include "sparse/cholesky.hpp"
#include "support/stages.hpp"

#include <Eigen/SparseCore>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>

namespace {

using namespace pfv;

/// CPU milliseconds of an action.
template <class Action>
double milliseconds(const Action& action) {
  const std::clock_t start = std::clock();
  action();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Everything up to S, between symmetry walls, with pressures on two faces.
struct Scene {
  ::support::Stages stages;
  Unknowns unknowns;
  PressureSystem system;
  ForceMatrix forces;
  Bases bases;
  Matrix6Xd yielding;
  Eigen::Matrix3Xd places;

  explicit Scene(int spheres) {
    Box box;
    for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
    box[Face::zlo].boundary = Boundary::pressure(0.0);
    box[Face::zhi].boundary = Boundary::pressure(1.0);
    stages = ::support::stages_of(dense_packing(spheres), box);
    const auto& [container, grains, network, boundaries, throats] = stages;
    unknowns = number_unknowns(network, boundaries, container);
    const ConductanceLaw law = ConductanceLaw::open_throat;
    const Conductances conductance = conductances(law, 1.0, network, throats, grains);
    system = assemble(network, conductance.value, unknowns, {});
    forces = force_matrix(network, grains, throats, viscous_shares(law, network, throats, grains), grains.size(),
                          {true, true, false});
    bases = measure_bases(network, boundaries, grains);
    places.resize(3, unknowns.count);
    for (int pore = 0; pore < network.pores(); ++pore)
      if (unknowns.of_pore[pore] >= 0) places.col(unknowns.of_pore[pore]) = network.pore_centres.col(pore);
    let_yield();
  }

  /// So much that S^T B S has 100 times the trace of G.
  void let_yield() {
    constexpr double ratio = 100.0;
    double of_g = 0.0, of_forces = forces.value.topRows<3>().squaredNorm();
    for (int i = 0; i < system.matrix.size(); ++i)
      for (int k = system.matrix.row_begin[i]; k < system.matrix.row_begin[i + 1]; ++k)
        if (system.matrix.column[k] == i) of_g += system.matrix.value[k];
    yielding = Matrix6Xd::Zero(6, forces.rows());
    yielding.topLeftCorner(3, forces.spheres).setConstant(ratio * of_g / of_forces);
  }
};

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

Sparse sparse(const SymmetricMatrix& g) {
  Sparse result(g.size(), g.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < g.size(); ++i)
    for (int k = g.row_begin[i]; k < g.row_begin[i + 1]; ++k) entries.emplace_back(i, g.column[k], g.value[k]);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// G + S^T B S.
SymmetricMatrix eliminated(const Scene& scene) {
  const ForceMatrix& forces = scene.forces;
  Sparse rooted(3 * forces.spheres, scene.unknowns.count);  // B^1/2 S
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < forces.spheres; ++k)
    for (int e = forces.row_begin[k]; e < forces.row_begin[k + 1]; ++e)
      for (int c = 0; c < 3; ++c)
        if (const int unknown = scene.unknowns.of_pore[forces.pore[e]]; unknown >= 0)
          entries.emplace_back(3 * k + c, unknown, std::sqrt(scene.yielding(c, k)) * forces.value(c, e));
  rooted.setFromTriplets(entries.begin(), entries.end());
  const Sparse sum = sparse(scene.system.matrix) + Sparse(rooted.transpose() * rooted);
  SymmetricMatrix result;
  for (int i = 0; i < sum.rows(); ++i) {
    for (Sparse::InnerIterator entry(sum, i); entry; ++entry) {
      result.column.push_back(static_cast<int>(entry.col()));
      result.value.push_back(entry.value());
    }
    result.row_begin.push_back(static_cast<int>(result.column.size()));
  }
  return result;
}

struct Measured {
  std::size_t entries;
  double order, factor, solve;
  Eigen::VectorXd x;
};

Measured measure(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& places, OrderingKind ordering,
                 const Eigen::VectorXd& b, const std::vector<double>& signs) {
  constexpr int solves = 20;
  Team alone;
  SparseCholesky factor;
  Measured found{0, 0.0, 0.0, 0.0, Eigen::VectorXd(matrix.size())};
  for (int pass = 0; pass < 2; ++pass) {  // warm memory, as within a run
    found.order = milliseconds([&] { factor.analyze(matrix.rows(), fill_reducing_ordering(ordering, matrix, places, alone)); });
    found.factor = milliseconds([&] { factor.factorize(matrix.rows(), alone, signs); });
    found.solve = milliseconds([&] {
      for (int k = 0; k < solves; ++k) factor.solve(b.data(), found.x.data(), alone);
    }) / solves;
  }
  found.entries = factor.entries();
  return found;
}

void row(int spheres, const std::string& name, const SymmetricMatrix& matrix, double assembled, const Measured& found,
         double differ) {
  std::printf("%d %s %d %.1f %.2f %.1f %.1f %.1f %.2f %.1e\n", spheres, name.c_str(), matrix.size(),
              static_cast<double>(matrix.column.size()) / matrix.size(), found.entries / 1e6, assembled,
              found.order, found.factor, found.solve, differ);
  std::fflush(stdout);
}

void compare(int spheres) {
  const Scene scene(spheres);
  const int count = scene.unknowns.count;
  Eigen::VectorXd b(count);
  for (int i = 0; i < count; ++i) b[i] = std::sin(1.0 + i);
  const auto name_of = [](OrderingKind kind) { return kind == OrderingKind::metis ? "metis" : "geometric"; };
  const OrderingKind orderings[] = {OrderingKind::geometric, OrderingKind::metis};
  const Matrix6Xd& yielding = scene.yielding;
  for (const OrderingKind kind : orderings)
    row(spheres, std::string("G,") + name_of(kind), scene.system.matrix, 0.0,
        measure(scene.system.matrix, scene.places, kind, b, {}), 0.0);
  SymmetricMatrix a;
  const double a_made = milliseconds([&] { a = eliminated(scene); });
  std::optional<Measured> first;
  for (const OrderingKind kind : orderings) {
    const Measured found = measure(a, scene.places, kind, b, {});
    row(spheres, std::string("A,") + name_of(kind), a, a_made, found, 0.0);
    if (!first) first = found;
  }
  ImplicitSystem k;
  const double k_made = milliseconds([&] {
    k = assemble_implicit(scene.system, scene.unknowns, scene.forces, scene.bases, yielding, {}, nullptr);
  });
  Eigen::Matrix3Xd places(3, k.matrix.size());
  places.leftCols(count) = scene.places;
  for (std::size_t v = 0; v < k.velocities.size(); ++v)
    places.col(count + static_cast<Eigen::Index>(v)) = scene.stages.spheres.centres.col(k.velocities[v].mover);
  Eigen::VectorXd both = Eigen::VectorXd::Zero(k.matrix.size());
  both.head(count) = -b;
  for (const OrderingKind kind : orderings) {
    const Measured found = measure(k.matrix, places, kind, both, k.signs);
    row(spheres, std::string("K,") + name_of(kind), k.matrix, k_made, found,
        (found.x.head(count) - first->x).lpNorm<Eigen::Infinity>() / first->x.lpNorm<Eigen::Infinity>());
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) compare(std::atoi(argv[k]));
}
