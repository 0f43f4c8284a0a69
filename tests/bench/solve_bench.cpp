// SPDX-License-Identifier: GPL-3.0-or-later
// CPU time of each stage of the linear solver, for each solver and ordering, on dense packings:
//   pfv_solve_bench
// `solve` of cholmod is held against what memory allows: counters `bandwidth_GB_s`, measured just
// before, `bound_ms`, the time to read the factor (doubles) twice at that bandwidth, and
// `over_bound`.
#include "pfv/pfv.hpp"
#include "solve/cholmod_factor.hpp"
#include "solve/ordering.hpp"
#include "pfv/dense_packing.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <ctime>
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

void order(benchmark::State& state, const Choice& choice) {
  const System& system = system_of(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    make_solver(choice.solver, choice.ordering)->order(system.matrix, system.places);
  }
  state.counters["unknowns"] = system.matrix.size();
}

void factor(benchmark::State& state, const Choice& choice) {
  const System& system = system_of(static_cast<int>(state.range(0)));
  const auto solver = make_solver(choice.solver, choice.ordering);
  solver->order(system.matrix, system.places);
  for (auto _ : state) solver->factor(system.matrix);
}

/// Entries of L, with the zeros that merged supernodes take in.
double factor_entries(const System& system, OrderingKind ordering) {
  const SymmetricMatrix& matrix = system.matrix;
  CholmodFactor factor;
  factor.analyze({matrix.size(), matrix.row_begin.data(), matrix.column.data(), nullptr},
                 fill_reducing_ordering(ordering, matrix, system.places));
  return static_cast<double>(factor.entries());
}

void solve(benchmark::State& state, const Choice& choice) {
  const System& system = system_of(static_cast<int>(state.range(0)));
  const auto solver = make_solver(choice.solver, choice.ordering);
  solver->order(system.matrix, system.places);
  solver->factor(system.matrix);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(system.matrix.size());
  Eigen::VectorXd x;
  const bool is_cholmod = choice.solver == SolverKind::cholmod;
  const double bytes = is_cholmod ? 8.0 * factor_entries(system, choice.ordering) : 0.0;
  const double bandwidth = is_cholmod ? read_bandwidth(static_cast<std::size_t>(bytes)) : 0.0;
  solver->solve(b, x);
  const double start = cpu_seconds();
  for (auto _ : state) solver->solve(b, x);
  const double seconds = (cpu_seconds() - start) / static_cast<double>(state.iterations());
  state.counters["residual"] = (multiply(system.matrix, x) - b).norm() / b.norm();
  if (!is_cholmod) return;
  const double bound = 2.0 * bytes / bandwidth;
  state.counters["entries_M"] = bytes / 8e6;
  state.counters["bandwidth_GB_s"] = bandwidth / 1e9;
  state.counters["bound_ms"] = 1e3 * bound;
  state.counters["over_bound"] = seconds / bound;
}

void add(const Choice& choice, int largest) {
  const auto name = [&](const char* stage) {
    return std::string(stage) + "/" + name_of(choice.solver) + "/" + name_of(choice.ordering);
  };
  const auto sizes = [&](benchmark::internal::Benchmark* bench) {
    for (const int spheres : {1000, 5000, 20000}) {
      if (spheres <= largest) bench->Arg(spheres);
    }
    bench->Unit(benchmark::kMillisecond);
  };
  sizes(benchmark::RegisterBenchmark(name("order").c_str(), order, choice));
  sizes(benchmark::RegisterBenchmark(name("factor").c_str(), factor, choice));
  sizes(benchmark::RegisterBenchmark(name("solve").c_str(), solve, choice));
}

}  // namespace

int main(int argc, char** argv) {
  add({SolverKind::cholmod, OrderingKind::geometric}, 20000);
  add({SolverKind::cholmod, OrderingKind::metis}, 20000);
  add({SolverKind::cholmod, OrderingKind::amd}, 20000);
#ifdef PFV_WITH_MUMPS
  add({SolverKind::mumps, OrderingKind::automatic}, 20000);
#endif
  add({SolverKind::klu2, OrderingKind::automatic}, 5000);
  add({SolverKind::cg, OrderingKind::automatic}, 20000);
  add({SolverKind::gauss_seidel, OrderingKind::automatic}, 5000);  // no solution at 20000
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
