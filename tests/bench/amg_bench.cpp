// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of doc/solvers.md about the solver amg, in Markdown:  pfv_amg_bench tolerance|starts|sizes|auto|flux [SPHERES...]
//   tolerance  error of forces and mass against the time of a solve, beside supernodal
//   starts     iterations of a solve by the number of changes between the last solutions that it sets out from
//   sizes      hierarchy and solves beside order, factor and solves of supernodal
//   auto       what `solver auto` costs over the better of the two, by how many solves a network serves
//   flux       a face with a pressure beside one with a flux, whose pores share an unknown
// Dense packings, solid fraction 0.6, symmetry walls, open-throat law. CPU time of one thread.
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "solve/amg_solver.hpp"
#include "step/automatic_solver.hpp"
#include "support/motions.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <malloc.h>
#include <string>
#include <vector>

namespace {

using namespace pfv;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Action>
double milliseconds(const Action& action) {
  const double start = cpu_seconds();
  action();
  return 1e3 * (cpu_seconds() - start);
}

double allocated_megabytes() {
  const auto heap = mallinfo2();
  return 1e-6 * static_cast<double>(heap.uordblks + heap.hblkhd);
}

Box closed_box() {
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zhi].boundary = Boundary::pressure(0.0);
  return box;
}

Box through_box() {
  Box box = closed_box();
  box[Face::zlo].boundary = Boundary::pressure(1.0);
  return box;
}

Box fed_box() {
  Box box = closed_box();
  box[Face::zlo].boundary = Boundary::flux(1e-3);
  return box;
}

/// Grains that settle, each on a way of its own.
class Motions {
 public:
  explicit Motions(const PackingArrays& packing)
      : positions_(packing.positions), phase_(positions_), turn_(positions_), jump_(positions_) {
    ::support::Random random(2);
    for (Eigen::Index k = 0; k < phase_.cols(); ++k) {
      phase_.col(k) = random.in_cube(0.0, 2.0 * ::support::pi);
      turn_.col(k) = random.in_cube(0.02, 0.06);
    }
  }
  /// Swings of 100 to 300 steps.
  Eigen::Matrix3Xd smooth(int step) const {
    Eigen::Matrix3Xd v = 0.1 * (phase_ + step * turn_).array().sin();
    v.row(2) -= positions_.row(2);
    return v;
  }
  /// The same, and 1 % of it that knows nothing of the step before.
  Eigen::Matrix3Xd rough(int step) {
    ::support::Random random(100 + static_cast<unsigned>(step));
    for (Eigen::Index k = 0; k < jump_.cols(); ++k) jump_.col(k) = random.in_cube(-1e-3, 1e-3);
    return smooth(step) + jump_;
  }

 private:
  Eigen::Matrix3Xd positions_, phase_, turn_, jump_;
};

// ------------------------------------------------------------------------------------- tolerance

struct Error {
  double rms = 0.0, worst = 0.0;  ///< of the force, over its rms
  void add(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& exact) {
    const auto mean = [](const Eigen::Matrix3Xd& f) {
      return std::sqrt(f.squaredNorm() / static_cast<double>(f.cols()));
    };
    rms = std::max(rms, mean(found - exact) / mean(exact));
    worst = std::max(worst, (found - exact).colwise().norm().maxCoeff() / mean(exact));
  }
};

struct Run {
  double cold = 0.0, step = 0.0;  ///< CPU milliseconds of the first solve and the mean of the others
  std::vector<Eigen::Matrix3Xd> forces;
  double mass_error = 0.0;
};

constexpr int run_steps = 20;

Run run_of(const Box& box, PackingArrays packing, bool moves, const Options& options) {
  Flow flow(box, Fluid{}, options);
  Motions motions(packing);
  Run run;
  for (int step = 0; step <= (moves ? run_steps : 0); ++step) {
    if (moves) packing.velocities = motions.smooth(step);
    run.forces.push_back(flow.step(packing.view(), 1e-9).total);
    if (step == 0) run.cold = 1e3 * flow.report().seconds.solve;
  }
  const Report report = flow.report();
  run.step = (1e3 * report.seconds.solve - run.cold) / run_steps;
  run.mass_error = std::abs(report.mass_error);
  return run;
}

void tolerance_row(const PackingArrays& packing, const Options& options, const std::vector<Run>& exact,
                   const std::string& label) {
  const Box boxes[]{through_box(), fed_box(), closed_box()};
  std::printf("| %d | %s |", static_cast<int>(packing.ids.size()), label.c_str());
  Error worst;
  std::string errors;
  Run last;
  double mass = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    last = run_of(boxes[k], packing, k == 2, options);
    Error error;
    for (std::size_t step = 0; step < last.forces.size(); ++step)
      error.add(last.forces[step], exact[k].forces[step]);
    char text[40];
    std::snprintf(text, sizeof text, " %.0e |", error.rms);
    errors += text;
    worst.worst = std::max(worst.worst, error.worst);
    mass = std::max(mass, last.mass_error);
  }
  std::printf(" %.3g | %.3g |%s %.0e | %.0e |\n", last.cold, last.step, errors.c_str(), worst.worst, mass);
  std::fflush(stdout);
}

void tolerance_table(const std::vector<int>& sizes) {
  std::printf("| spheres | tolerance | first solve, ms | later solve, ms | rms error of forces: through | flux | "
              "moving | worst sphere | mass error |\n|--|--|--|--|--|--|--|--|--|\n");
  for (const int spheres : sizes) {
    const PackingArrays packing = dense_packing(spheres);
    Options options;
    std::vector<Run> exact{run_of(through_box(), packing, false, options), run_of(fed_box(), packing, false, options),
                           run_of(closed_box(), packing, true, options)};
    options.solver = SolverKind::amg;
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
      options.tolerance = tolerance;
      char text[20];
      std::snprintf(text, sizeof text, "%.0e", tolerance);
      tolerance_row(packing, options, exact, text);
    }
    tolerance_row(packing, Options{}, exact, "supernodal");
  }
}

// --------------------------------------------------------------------- matrices and right-hand sides

struct System {
  ::support::Stages stages;
  ForceMatrix forces;
  Bases bases;
  Unknowns unknowns;
  PressureSystem system;
  Eigen::Matrix3Xd places;

  explicit System(const PackingArrays& packing, const Box& box = closed_box())
      : stages(::support::stages_of(packing, box)),
        forces(::support::force_matrix_of(stages)),
        bases(::support::bases_of(stages)),
        unknowns(number_unknowns(stages.network, stages.boundaries, stages.box)),
        system(assemble(stages.network,
                        conductances(ConductanceLaw::open_throat, 1.0, stages.network, stages.throats,
                                     stages.spheres).value,
                        unknowns, {})),
        places(3, unknowns.count) {
    for (int pore = 0; pore < stages.network.pores(); ++pore)
      if (unknowns.of_pore[pore] >= 0) places.col(unknowns.of_pore[pore]) = stages.network.pore_centres.col(pore);
  }
  Eigen::VectorXd right_side(const Eigen::Matrix3Xd& velocities) const {
    Team alone;
    Eigen::VectorXd rates(stages.network.pores()), b;
    reciprocal_rates(forces, {}, bases, ::support::motion_of(velocities, stages.box), alone, rates);
    Eigen::VectorXd imposed = Eigen::VectorXd::Zero(stages.network.pores());
    impose_pressures(stages.network, stages.boundaries, stages.box, 0.0, imposed);
    right_hand_side(system, unknowns, stages.box, -rates, imposed, b);
    return b;
  }
};

/// Means over the later steps of a sequence.
struct Sequence {
  double iterations = 0.0, milliseconds = 0.0;
};

Sequence sequence_of(LinearSolver& solver, const std::vector<Eigen::VectorXd>& right_sides) {
  constexpr std::size_t begun = 14;
  Sequence mean;
  Eigen::VectorXd x;
  for (std::size_t step = 0; step < right_sides.size(); ++step) {
    const double spent = milliseconds([&] { solver.solve(right_sides[step], x); });
    if (step < begun) continue;
    mean.iterations += solver.iterations();
    mean.milliseconds += spent;
  }
  const auto count = static_cast<double>(right_sides.size() - begun);
  return {mean.iterations / count, mean.milliseconds / count};
}

void starts_table(const std::vector<int>& sizes) {
  std::printf("| spheres, motion | tolerance | changes kept: 0 | 1 | 2 | 4 | 6 | 8 | 12 |\n"
              "|--|--|--|--|--|--|--|--|--|\n");
  for (const int spheres : sizes) {
    const PackingArrays packing = dense_packing(spheres);
    const System system(packing);
    Motions motions(packing);
    for (const bool rough : {false, true}) {
      std::vector<Eigen::VectorXd> right_sides;
      for (int step = 0; step < 40; ++step)
        right_sides.push_back(system.right_side(rough ? motions.rough(step) : motions.smooth(step)));
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        std::printf("| %d, %s | %.0e |", spheres, rough ? "1 % of it at random" : "smooth", tolerance);
        for (const std::size_t kept : {0, 1, 2, 4, 6, 8, 12}) {
          AmgSolver solver(tolerance, kept);
          solver.order(system.system.matrix, system.places);
          solver.factor(system.system.matrix);
          const Sequence mean = sequence_of(solver, right_sides);
          std::printf(" %.1f, %.3g ms |", mean.iterations, mean.milliseconds);
        }
        std::printf("\n");
        std::fflush(stdout);
      }
    }
  }
}

// ----------------------------------------------------------------------------------------- sizes

struct Costs {
  double order = 0.0, factor = 0.0, memory = 0.0, cold = 0.0, warm = 0.0, warm_iterations = 0.0;
  int iterations = 0;
};

Costs costs_of(const System& system, const std::vector<Eigen::VectorXd>& right_sides, const Options& options) {
  Costs costs;
  const double before = allocated_megabytes();
  const auto solver = make_solver(options);
  costs.order = milliseconds([&] { solver->order(system.system.matrix, system.places); });
  costs.factor = milliseconds([&] { solver->factor(system.system.matrix); });
  Eigen::VectorXd x;
  costs.cold = milliseconds([&] { solver->solve(right_sides.front(), x); });
  costs.iterations = solver->iterations();
  const Sequence mean = sequence_of(*solver, right_sides);
  costs.memory = allocated_megabytes() - before;
  costs.warm = mean.milliseconds;
  costs.warm_iterations = mean.iterations;
  return costs;
}

/// Of `spheres` that settle: supernodal's and amg's.
struct Choice {
  int unknowns = 0;
  Costs factor, amg;
};

Choice choice_of(int spheres) {
  const PackingArrays packing = dense_packing(spheres);
  const System system(packing);
  const Motions motions(packing);
  std::vector<Eigen::VectorXd> right_sides;
  for (int step = 0; step < 22; ++step) right_sides.push_back(system.right_side(motions.smooth(step)));
  Options amg;
  amg.solver = SolverKind::amg;
  return {system.unknowns.count, costs_of(system, right_sides, {}), costs_of(system, right_sides, amg)};
}

void sizes_table(const std::vector<int>& sizes) {
  std::printf("| spheres, unknowns | supernodal: order + factor, s | MB held | solve, ms | amg: hierarchy, s | "
              "MB held | first solve: iterations, ms | later solve: iterations, ms | steps a network below which amg "
              "takes less |\n"
              "|--|--|--|--|--|--|--|--|--|\n");
  for (const int spheres : sizes) {
    const auto [unknowns, ours, its] = choice_of(spheres);
    const double steps = (ours.order + ours.factor - its.order - its.factor) / (its.warm - ours.warm);
    std::printf("| %d, %d | %.3g | %.0f | %.3g | %.3g | %.0f | %d, %.3g | %.1f, %.3g | %.0f |\n", spheres,
                unknowns, 1e-3 * (ours.order + ours.factor), ours.memory, ours.warm,
                1e-3 * (its.order + its.factor), its.memory, its.iterations, its.cold, its.warm_iterations, its.warm,
                steps);
    std::fflush(stdout);
  }
}

// ------------------------------------------------------------------------------------------ auto

double cost_of(const Costs& costs, int solves) {
  return costs.order + costs.factor + costs.cold + (solves - 1) * costs.warm;
}

/// Of a network by the choice that `auto` makes from solve to solve, ms.
double cost_by_choice(const Choice& choice, int spheres, int solves, AutomaticSolver& automatic, Counts& counts) {
  double cost = 0.0;
  SolverKind serving = SolverKind::automatic;  // none yet
  automatic.begin(spheres, counts);
  for (int solve = 0; solve < solves; ++solve, ++counts.solve) {
    const SolverKind now = automatic.now(counts);
    const Costs& costs = now == SolverKind::amg ? choice.amg : choice.factor;
    cost += now == serving ? costs.warm : costs.order + costs.factor + costs.cold;
    serving = now;
  }
  return cost;
}

void auto_table(const std::vector<int>& sizes) {
  constexpr int served[] = {1, 10, 100, 1000, 10000};
  std::printf("| spheres |");
  for (const int solves : served) std::printf(" %d |", solves);
  std::printf("\n|--|--|--|--|--|--|\n");
  for (const int spheres : sizes) {
    const Choice choice = choice_of(spheres);
    const auto better = [&](int solves) { return std::min(cost_of(choice.factor, solves), cost_of(choice.amg, solves)); };
    std::printf("| %d |", spheres);
    for (const int solves : served) {
      AutomaticSolver automatic({}, false);
      Counts counts;
      const double first = cost_by_choice(choice, spheres, solves, automatic, counts);
      const double later = cost_by_choice(choice, spheres, solves, automatic, counts);
      std::printf(" %.2f, %.2f |", first / better(solves), later / better(solves));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

// ------------------------------------------------------------------------------------------ flux

int entries_of_fullest_row(const SymmetricMatrix& matrix) {
  int most = 0;
  for (int row = 0; row < matrix.size(); ++row)
    most = std::max(most, matrix.row_begin[row + 1] - matrix.row_begin[row]);
  return most;
}

void flux_table(const std::vector<int>& sizes) {
  std::printf("| spheres | pressure: iterations | hierarchy, s | flux: iterations | hierarchy, s | entries of the "
              "fullest row |\n|--|--|--|--|--|--|\n");
  Options amg;
  amg.solver = SolverKind::amg;
  for (const int spheres : sizes) {
    const PackingArrays packing = dense_packing(spheres);
    const Eigen::Matrix3Xd still = Eigen::Matrix3Xd::Zero(3, spheres);
    std::printf("| %d |", spheres);
    int fullest = 0;
    for (const Box& box : {through_box(), fed_box()}) {
      const System system(packing, box);
      const auto solver = make_solver(amg);
      solver->order(system.system.matrix);
      const double built = milliseconds([&] { solver->factor(system.system.matrix); });
      Eigen::VectorXd x;
      solver->solve(system.right_side(still), x);
      std::printf(" %d | %.3g |", solver->iterations(), 1e-3 * built);
      fullest = entries_of_fullest_row(system.system.matrix);
    }
    std::printf(" %d |\n", fullest);
    std::fflush(stdout);
  }
}

}  // namespace

/// MPI's start is no part of a hierarchy.
void start_mpi() {
  SymmetricMatrix one;
  one.row_begin = {0, 1};
  one.column = {0};
  one.value = {1.0};
  AmgSolver solver(0.5);
  solver.order(one, {});
  solver.factor(one);
}

int main(int argc, char** argv) {
  start_mpi();
  const std::string table = argc > 1 ? argv[1] : "";
  std::vector<int> sizes;
  for (int k = 2; k < argc; ++k) sizes.push_back(std::atoi(argv[k]));
  const auto or_else = [&](std::vector<int> usual) { return sizes.empty() ? usual : sizes; };
  if (table == "tolerance") return tolerance_table(or_else({5000, 20000})), 0;
  if (table == "starts") return starts_table(or_else({5000})), 0;
  if (table == "sizes") return sizes_table(or_else({5000, 20000})), 0;
  if (table == "auto") return auto_table(or_else({1000, 5000, 20000})), 0;
  if (table == "flux") return flux_table(or_else({5000, 20000})), 0;
  std::fprintf(stderr, "usage: pfv_amg_bench tolerance|starts|sizes|auto|flux [SPHERES...]\n");
  return 2;
}
