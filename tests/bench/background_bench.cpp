// SPDX-License-Identifier: GPL-3.0-or-later
// What rebuilds in the background save:
//   pfv_background_bench [SPHERES ...]
// Grains that sink and strain their pores by 1 % every so many steps, with each new network built by the
// step itself and in the background, in turn. Times of a step, all rebuilds included: CPU time of the
// thread that steps, which is what a run takes where the other core is idle, and wall time. No time passes
// between the flow steps here, as that of the grains would.
#include "work/phase_clock.hpp"
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

namespace {

using namespace pfv;

struct Column {
  Box box;
  PackingArrays packing;

  explicit Column(int spheres) : packing(dense_packing(spheres)) {
    for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
    box[Face::zhi].boundary = Boundary::pressure(0.0);
    box[Face::zhi].velocity = -1.0;
    packing.velocities = Eigen::Matrix3Xd::Zero(3, spheres);
    packing.velocities.row(2) = -packing.positions.row(2);
  }
  void advance(double dt) {
    packing.positions += dt * packing.velocities;
    box.upper[2] -= dt;
  }
};

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Times {
  double thread = 0.0, wall = 0.0, waited = 0.0;  ///< s a step
  std::int64_t networks = 0;
};

Times run(Column column, double dt, int steps, int lag, SolverKind solver) {
  Options options;
  options.rebuild_lag = lag;
  options.solver = solver;
  Flow flow(column.box, Fluid{}, options);
  flow.evaluate(column.packing.view());
  const double thread = thread_seconds(), wall = wall_seconds();
  for (int step = 0; step < steps; ++step) {
    flow.set_box(column.box);
    flow.step(column.packing.view(), dt);
    column.advance(dt);
  }
  const double n = steps;
  return {(thread_seconds() - thread) / n, (wall_seconds() - wall) / n,
          flow.report().wall_seconds.waited / n, flow.retriangulations()};
}

template <class Member>
double median(std::vector<Times> runs, const Member& member) {
  std::sort(runs.begin(), runs.end(),
            [&](const Times& a, const Times& b) { return a.*member < b.*member; });
  return 1e3 * runs[runs.size() / 2].*member;
}

/// `n`: steps from network to network.
void compare(const Column& column, int n, SolverKind solver) {
  constexpr int repeats = 3, networks = 2;
  const auto spheres = static_cast<int>(column.packing.radii.size());
  Options kept;
  kept.retriangulation_strain = std::numeric_limits<double>::infinity();
  kept.solver = solver;
  Flow flow(column.box, Fluid{}, kept);
  double rebuild = thread_seconds();
  flow.step(column.packing.view(), 1.0);
  rebuild = thread_seconds() - rebuild;
  const double dt = 0.01 / flow.strain() / (n - 0.5);
  double step = thread_seconds();
  for (int i = 0; i < 5; ++i) flow.step(column.packing.view(), dt);
  step = (thread_seconds() - step) / 5;
  // a fifth more, because the two threads share caches and memory
  const int lag = static_cast<int>(std::ceil(1.2 * rebuild / step));
  if (lag >= n) {
    std::printf("| %d | %s | %d | %d | not fast enough for networks of so few steps |||||||\n", spheres, name_of(solver), n,
                lag);
    return;
  }
  const int steps = networks * n + lag + 5;  // until the last of them is in use either way
  std::vector<Times> within, beside;
  for (int i = 0; i < repeats; ++i) {
    within.push_back(run(column, dt, steps, 0, solver));
    beside.push_back(run(column, dt, steps, lag, solver));
  }
  const double a = median(within, &Times::thread), b = median(beside, &Times::thread);
  std::printf("| %d | %s | %d | %d | %lld, %lld | %.3g | %.3g | %.0f %% | %.3g | %.3g | %.3g |\n", spheres,
              name_of(solver), n, lag, static_cast<long long>(within[0].networks),
              static_cast<long long>(beside[0].networks), a, b, 100.0 * (1.0 - b / a),
              median(within, &Times::wall), median(beside, &Times::wall),
              median(beside, &Times::waited));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {5000, 20000};
  double load = 0.0;
  if (getloadavg(&load, 1) == 1) std::printf("Load average %.1f.\n\n", load);
  std::puts("| spheres | solver | steps a network | `rebuild_lag` | new networks: within, beside | stepping thread, "
            "ms a step: within | beside | saved | wall, ms a step: within | beside | of it waited |\n"
            "|--|--|--|--|--|--|--|--|--|--|--|");
  for (const int spheres : sizes) {
    const Column column(spheres);
    for (const SolverKind solver : {SolverKind::supernodal, SolverKind::amg})
      for (const int n : {100, 400}) compare(column, n, solver);
  }
}
