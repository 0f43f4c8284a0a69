// SPDX-License-Identifier: GPL-3.0-or-later
// CPU time of each phase on dense random packings:
//   pfv_phases --benchmark_format=json
// `rebuild` is everything from a packing to forces, `step` what a kept network costs. Quote ratios of
// one run: absolute times are the machine's.
#include "network/pore_boundaries.hpp"
#include "network/pore_network.hpp"
#include "network/triangulation.hpp"
#include "pfv/pfv.hpp"
#include "physics/conductances.hpp"
#include "physics/force_matrix.hpp"
#include "physics/throats.hpp"
#include "physics/volume_rates.hpp"
#include "solve/pressure_system.hpp"
#include "pfv/dense_packing.hpp"

#include <benchmark/benchmark.h>
#include <map>
#include <random>

namespace {

using namespace pfv;

Box drained_box() {
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::pressure(1.0);
  return box;
}

/// Moving towards the bottom, so that the volume rates are at work.
const PackingArrays& packing_of(int spheres) {
  static std::map<int, PackingArrays> made;
  const auto found = made.find(spheres);
  if (found != made.end()) return found->second;
  PackingArrays packing = dense_packing(spheres);
  packing.velocities = Eigen::Matrix3Xd::Zero(3, spheres);
  packing.velocities.row(2) = -packing.positions.row(2);
  return made.emplace(spheres, std::move(packing)).first->second;
}

/// The stages' results up to the one that is timed.
struct Stages {
  Box box = drained_box();
  Spheres spheres;
  PoreNetwork network;
  PoreBoundaries boundaries;
  Throats throats;
  Conductances conductance;
  Unknowns unknowns;
  PressureSystem system;

  explicit Stages(int n) {
    const PackingArrays& packing = packing_of(n);
    spheres = {packing.ids, packing.positions, packing.radii, Eigen::Vector3d::Ones(), {}};
    network = build_network(spheres, Eigen::Vector3d::Zero()).network;
    boundaries = find_pore_boundaries(network, box);
    throats = measure_throats(network, boundaries, spheres);
    conductance =
        conductances(ConductanceLaw::hydraulic_radius, 1.0, network, throats, spheres);
    unknowns = number_unknowns(network, boundaries, box);
    system = assemble(network, conductance.value, unknowns, {});
  }
};

void count(benchmark::State& state, const Stages& stages) {
  state.counters["pores"] = stages.network.pores();
  state.counters["unknowns"] = stages.unknowns.count;
}

void triangulation(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(triangulate(stages.spheres));
  count(state, stages);
}

void network(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(build_network(stages.spheres, Eigen::Vector3d::Zero()));
  count(state, stages);
}

void throats(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(measure_throats(stages.network, stages.boundaries, stages.spheres));
}

void assembly(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        assemble(stages.network, stages.conductance.value, stages.unknowns, {}));
}

void ordering(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state) make_solver(SolverKind::automatic, OrderingKind::automatic)
      ->order(stages.system.matrix);
}

void factorisation(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  const auto solver = make_solver(SolverKind::automatic, OrderingKind::automatic);
  solver->order(stages.system.matrix);
  for (auto _ : state) solver->factor(stages.system.matrix);
}

void triangular_solves(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  const auto solver = make_solver(SolverKind::automatic, OrderingKind::automatic);
  solver->order(stages.system.matrix);
  solver->factor(stages.system.matrix);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(stages.unknowns.count);
  Eigen::VectorXd x = b;
  for (auto _ : state) solver->solve(b, x);
}

ForceMatrix force_matrix_of(const Stages& stages) {
  return force_matrix(stages.network, stages.throats,
                      viscous_shares(Options{}.conductance, stages.network, stages.throats,
                                     stages.spheres),
                      stages.spheres.size(), {true, true});
}

void force_matrix_build(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(force_matrix_of(stages));
}

void forces(benchmark::State& state) {
  const Stages stages(static_cast<int>(state.range(0)));
  const ForceMatrix matrix = force_matrix_of(stages);
  const Eigen::VectorXd p = Eigen::VectorXd::Ones(stages.network.pores());
  for (auto _ : state) benchmark::DoNotOptimize(multiply(matrix, p));
}

void rebuild(benchmark::State& state) {
  const PackingArrays& packing = packing_of(static_cast<int>(state.range(0)));
  Flow flow(drained_box(), Fluid{});
  for (auto _ : state) {
    flow.rebuild();
    benchmark::DoNotOptimize(flow.evaluate(packing.view()));
  }
  state.counters["peak_memory_MB"] =
      static_cast<double>(flow.report().peak_memory_bytes) / 1048576.0;
}

/// Steps in which the velocities change by 0.01 %, each its own way.
void steps(benchmark::State& state, const Options& options) {
  PackingArrays packing = packing_of(static_cast<int>(state.range(0)));
  Flow flow(drained_box(), Fluid{}, options);
  flow.evaluate(packing.view());
  std::minstd_rand random(1);
  for (auto _ : state) {
    state.PauseTiming();
    for (double& v : packing.velocities.reshaped())
      v *= 1.0 + 1e-4 * (static_cast<double>(random()) / random.max() - 0.5);
    state.ResumeTiming();
    benchmark::DoNotOptimize(flow.evaluate(packing.view()));
  }
  state.counters["residual"] = flow.report().residual;
}

void step(benchmark::State& state) { steps(state, {}); }

void step_mixed(benchmark::State& state) {
  Options options;
  options.precision = Precision::mixed;
  steps(state, options);
}

#define PFV_PHASE(function) \
  BENCHMARK(function)->Arg(1000)->Arg(5000)->Arg(20000)->Unit(benchmark::kMillisecond)

PFV_PHASE(triangulation);
PFV_PHASE(network);
PFV_PHASE(throats);
PFV_PHASE(assembly);
PFV_PHASE(ordering);
PFV_PHASE(factorisation);
PFV_PHASE(triangular_solves);
PFV_PHASE(force_matrix_build);
PFV_PHASE(forces);
PFV_PHASE(rebuild);
PFV_PHASE(step);
PFV_PHASE(step_mixed);

}  // namespace
