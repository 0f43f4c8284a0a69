// SPDX-License-Identifier: GPL-3.0-or-later
// Every linear solver on the same matrices, those of dense packings: a network's order and factor, and
// solves, on one thread. tests/bench/solver_tables.py solvers makes the table of doc/solvers.md from it:
//   pfv_solve_bench --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true
// Counters, milliseconds of CPU: `order`, `factor`, `solve`, and `hundred`, order + factor + 100 solves.
// `memory_MB` is what the solver holds after a solve. `bound`, of supernodal: the time to read the factor
// (doubles) twice at `bandwidth_GB_s`, which is measured just before.
#include "pfv/pfv.hpp"
#include "solve/fill_reducing_ordering.hpp"
#include "solve/linear_solver.hpp"
#include "problem/solver_abilities.hpp"
#include "sparse/cholesky.hpp"
#include "pfv/dense_packing.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <ctime>
#include <malloc.h>
#include <map>
#include <numeric>

namespace {

using namespace pfv;

struct System {
  SymmetricMatrix matrix;
  Eigen::Matrix3Xd places;
};

const System& system_of(int spheres) {
  static std::map<int, System> made;
  const auto found = made.find(spheres);
  if (found != made.end()) return found->second;
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::pressure(1.0);
  const ::support::Stages stages = ::support::stages_of(pfv::dense_packing(spheres), box);
  const Unknowns unknowns = number_unknowns(stages.network, stages.boundaries, box);
  const Conductances conductance = conductances(ConductanceLaw::hydraulic_radius, 1.0,
                                                stages.network, stages.throats, stages.spheres);
  System system{assemble(stages.network, conductance.value, unknowns, {}).matrix,
                Eigen::Matrix3Xd(3, unknowns.count)};
  for (int pore = 0; pore < stages.network.pores(); ++pore) {
    const int unknown = unknowns.of_pore[pore];
    if (unknown >= 0) system.places.col(unknown) = stages.network.pore_centres.col(pore);
  }
  return made.emplace(spheres, std::move(system)).first->second;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

constexpr std::size_t streams = 8;

/// As wide as the solver's own loops.
#ifdef __x86_64__
__attribute__((target_clones("avx2", "default")))
#endif
double sum_of_streams(const double* values, std::size_t length) {
  double sums[streams][8] = {};
  for (std::size_t k = 0; k + 8 <= length; k += 8) {
    for (std::size_t s = 0; s < streams; ++s) {
      for (std::size_t lane = 0; lane < 8; ++lane) sums[s][lane] += values[s * length + k + lane];
    }
  }
  double sum = 0.0;
  for (const auto& stream : sums) sum = std::accumulate(stream, stream + 8, sum);
  return sum;
}

/// Best of several reads of an array of `bytes`, in several streams at once, one thread.
double read_bandwidth(std::size_t bytes) {
  const std::size_t length = std::max<std::size_t>(bytes / sizeof(double) / streams, 1024);
  const std::vector<double> values(streams * length, 1.0);
  const auto repeats = std::max<std::size_t>(1, (std::size_t{1} << 28) / (values.size() * 8));
  double best = 0.0;
  for (int trial = 0; trial < 7; ++trial) {
    const double start = cpu_seconds();
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      benchmark::DoNotOptimize(sum_of_streams(values.data(), length));
      benchmark::ClobberMemory();
    }
    const double read = static_cast<double>(repeats * values.size() * sizeof(double));
    best = std::max(best, read / (cpu_seconds() - start));
  }
  return best;
}

struct Choice {
  SolverKind solver;
  OrderingKind ordering;
};

/// Entries of L, with the zeros that merged supernodes take in.
double factor_entries(const System& system, OrderingKind ordering) {
  const SymmetricMatrix& matrix = system.matrix;
  SparseCholesky factor;
  factor.analyze({matrix.size(), matrix.row_begin.data(), matrix.column.data(), nullptr},
                 fill_reducing_ordering(ordering, matrix, system.places));
  return static_cast<double>(factor.entries());
}

/// CPU milliseconds of an action.
template <class Action>
double milliseconds(const Action& action) {
  const double start = cpu_seconds();
  action();
  return 1e3 * (cpu_seconds() - start);
}

double allocated_bytes() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd);
}

void count_bound(benchmark::State& state, const System& system, OrderingKind ordering) {
  const double bytes = 8.0 * factor_entries(system, ordering);
  const double bandwidth = read_bandwidth(static_cast<std::size_t>(bytes));
  state.counters["entries_M"] = bytes / 8e6;
  state.counters["bandwidth_GB_s"] = bandwidth / 1e9;
  state.counters["bound"] = 2e3 * bytes / bandwidth;
}

/// A rebuild and some solves with the solver of an earlier network, as in a run.
void rebuild(benchmark::State& state, const Choice& choice) {
  const System& system = system_of(static_cast<int>(state.range(0)));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(system.matrix.size());
  const int solves = is_iterative(choice.solver) ? 1 : 20;
  const double before = allocated_bytes();
  const auto solver = make_solver(choice.solver, choice.ordering);
  Eigen::VectorXd x;
  solver->order(system.matrix, system.places);
  solver->factor(system.matrix);
  solver->solve(b, x);
  state.counters["memory_MB"] = 1e-6 * (allocated_bytes() - before);
  double order = 0.0, factor = 0.0, solve = 0.0;
  for (auto _ : state) {
    order += milliseconds([&] { solver->order(system.matrix, system.places); });
    factor += milliseconds([&] { solver->factor(system.matrix); });
    if (is_iterative(choice.solver)) x.setZero();
    solve += milliseconds([&] {
      for (int k = 0; k < solves; ++k) solver->solve(b, x);
    }) / solves;
  }
  const auto mean = [&](double sum) { return sum / static_cast<double>(state.iterations()); };
  state.counters["order"] = mean(order);
  state.counters["factor"] = mean(factor);
  state.counters["solve"] = mean(solve);
  state.counters["hundred"] = mean(order + factor + 100.0 * solve);
  state.counters["unknowns"] = system.matrix.size();
  state.counters["residual"] = (multiply(system.matrix, x) - b).norm() / b.norm();
  if (choice.solver == SolverKind::supernodal) count_bound(state, system, choice.ordering);
}

void add(const Choice& choice, int largest) {
  const std::string name = std::string(name_of(choice.solver)) + "/" +
                           name_of(resolved(choice.solver, choice.ordering));
  for (const int spheres : {1000, 5000, 20000})
    if (spheres <= largest)
      benchmark::RegisterBenchmark(name.c_str(), rebuild, choice)
          ->Arg(spheres)
          ->Iterations(std::max(1, 5000 / spheres))
          ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  for (const SolverKind solver : {SolverKind::supernodal, SolverKind::cholmod, SolverKind::tacho})
    for (const OrderingKind ordering :
         {OrderingKind::geometric, OrderingKind::metis, OrderingKind::amd})
      add({solver, ordering}, 20000);
  if (is_built(SolverKind::mumps))
    add({SolverKind::mumps, OrderingKind::automatic}, 20000);
  add({SolverKind::klu2, OrderingKind::automatic}, 5000);  // a minute at 20000
  add({SolverKind::amg, OrderingKind::automatic}, 20000);
  add({SolverKind::cg, OrderingKind::automatic}, 20000);
  add({SolverKind::gauss_seidel, OrderingKind::automatic}, 1000);  // ten seconds a solve at 5000
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
