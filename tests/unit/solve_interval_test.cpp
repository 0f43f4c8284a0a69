// SPDX-License-Identifier: GPL-3.0-or-later
// When the flow is solved between grains that move little (`couple_every auto`).
#include "pfv/solve_interval.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace solve_interval_test {
namespace {

constexpr double tolerance = 1e-3;
constexpr int any = 1 << 20;  // steps: no limit

/// Loads on two grains and a face that follow f(t), solved for when the interval says so.
struct Host {
  pfv::SolveInterval interval{tolerance};
  pfv::Packing::Ids ids = pfv::Packing::Ids::LinSpaced(2, 1, 2);
  std::function<double(double)> load;
  int most = any, solves = 0;
  double last = 0.0;  // step of the last solve
  double answer = 0.0;

  explicit Host(std::function<double(double)> f) : load(std::move(f)) {}

  void take(double mean, int steps) {
    pfv::Forces forces;
    forces.total = Eigen::Matrix3Xd::Constant(3, ids.size(), mean);
    forces.torque = forces.total;
    std::vector<Eigen::Vector3d> faces(6);
    std::fill(faces.begin(), faces.end(), Eigen::Vector3d::Zero());
    faces[5] = Eigen::Vector3d(0.0, 0.0, mean);
    interval.take(ids, forces, faces, steps, 1.0, 1.0, 0.1, most, false, answer);
    ++solves;
  }
  /// The load of a solve is that of the middle of its interval, as with mean velocities.
  void run(int steps, int first = 0) {
    int since = 0;
    if (first == 0) take(load(-0.5), 1);
    double solved_at = first;
    for (int step = first + 1; step <= first + steps; ++step) {
      ++since;
      if (since < interval.steps()) continue;
      take(load(solved_at + 0.5 * since), since);
      last = solved_at = step;
      since = 0;
    }
  }
};

TEST(SolveInterval, GrowsToWhatIsAllowedWhereNothingChanges) {
  Host still([](double) { return 0.5; });
  still.run(20000);
  EXPECT_EQ(still.interval.steps(), 1000);
  EXPECT_LT(still.solves, 35);
  EXPECT_EQ(still.interval.error(), 0.0);
  Host bounded([](double) { return 0.5; });
  bounded.most = 7;
  bounded.run(700);
  EXPECT_EQ(bounded.interval.steps(), 7);
}

TEST(SolveInterval, HoldsTheErrorAtTheTolerance) {
  // over a period of 20000 steps, half of the load: a trend that turns
  Host swinging([](double t) { return 0.5 + 0.4 * std::sin(2.0 * M_PI * t / 20000.0); });
  swinging.run(40000);
  EXPECT_LT(swinging.interval.largest_error(), 3.0 * tolerance);
  EXPECT_LT(swinging.solves, 1200);  // held alone it would take 40000 * 1.3e-4 / 7e-4 = 7000
  EXPECT_GT(swinging.solves, 100);
}

TEST(SolveInterval, ATrendGoesOnWithItsSlope) {
  Host growing([](double t) { return 0.1 + 1e-4 * t; });
  growing.run(4000);
  EXPECT_LT(growing.interval.error(), 1e-12);
  EXPECT_NEAR(growing.interval.held().slope(0, 0), 1e-4, 1e-12);
  EXPECT_NEAR(growing.interval.held().face_slope[5][2], 1e-4, 1e-12);
}

TEST(SolveInterval, NoiseIsHeldAndNotFollowed) {
  int sign = 1;
  Host noisy([&](double) { return 0.5 + 0.05 * tolerance * (sign = -sign); });
  noisy.run(3000);
  EXPECT_GT(noisy.interval.steps(), 1);
  EXPECT_EQ(noisy.interval.held().slope.norm(), 0.0);
}

/// A load that swings from solve to solve by a part of the load of 1.
Host swinging_by(double part, double answer) {
  Host host([part, sign = 1](double) mutable { return 0.5 + 0.5 * part * (sign = -sign); });
  host.answer = answer;
  host.run(3000);
  return host;
}

TEST(SolveInterval, WhatComesAndGoesBeforeGrainsAnswerIsNoError) {
  constexpr double part = tolerance, answer = 200.0;
  EXPECT_EQ(swinging_by(part, 0.0).interval.steps(), 1);
  const Host host = swinging_by(part, answer);
  EXPECT_GT(host.interval.steps(), 10);
  EXPECT_LT(host.interval.error(), tolerance);
  // but for what is many times the tolerance
  EXPECT_EQ(swinging_by(20.0 * tolerance, answer).interval.steps(), 1);
}

TEST(SolveInterval, WhatLastsIsAnErrorHoweverSlowlyGrainsAnswer) {
  Host at_once([](double t) { return 0.5 + 4e-5 * t; }), slowly = at_once;
  slowly.answer = 200.0;
  for (Host* host : {&at_once, &slowly}) {
    host->most = 1;  // held, not continued
    host->run(2000);
  }
  EXPECT_GT(at_once.interval.error(), 5e-5);
  EXPECT_NEAR(slowly.interval.error(), at_once.interval.error(), 0.1 * at_once.interval.error());
}

TEST(SolveInterval, ANewNetworkIsNoChangeInTime) {
  Host host([](double) { return 0.5; });
  host.run(5000);
  const int before = host.interval.steps();
  pfv::Forces forces;
  forces.total = forces.torque = Eigen::Matrix3Xd::Constant(3, 2, 0.6);
  std::vector<Eigen::Vector3d> faces(6);
  std::fill(faces.begin(), faces.end(), Eigen::Vector3d(0.0, 0.0, 0.6));
  host.interval.take(host.ids, forces, faces, before, 1.0, 1.0, 0.1, any, true);
  EXPECT_EQ(host.interval.steps(), before);
  EXPECT_EQ(host.interval.largest_error(), 0.0);
  EXPECT_EQ(host.interval.held().slope.norm(), 0.0);
}

TEST(SolveInterval, LoadsOfAnotherNetworkAreHeldAndLeaveWhatIsKnownOfTime) {
  Host growing([](double t) { return 0.1 + 1e-4 * t; });
  growing.run(4000);
  const int before = growing.interval.steps();
  // the next solve, then the same instant on a network that makes all loads a fifth larger
  const double jump = 0.1;
  double now = growing.last + 0.5 * before;
  growing.take(growing.load(now), before);
  pfv::Forces forces;
  forces.total = forces.torque = Eigen::Matrix3Xd::Constant(3, 2, growing.load(now) + jump);
  std::vector<Eigen::Vector3d> faces(6);
  std::fill(faces.begin(), faces.end(), Eigen::Vector3d::Zero());
  faces[5] = Eigen::Vector3d(0.0, 0.0, growing.load(now) + jump);
  growing.interval.put_on_network(forces, faces);
  EXPECT_NEAR(growing.interval.held().slope(0, 0), 1e-4, 1e-12);
  const int steps = growing.interval.steps();
  now += 0.5 * (before + steps);
  growing.take(growing.load(now) + jump, steps);
  EXPECT_LT(growing.interval.error(), 1e-12);
  // over the load on the grains, which is the one that errs most here
  EXPECT_NEAR(growing.interval.change() * (growing.load(now) + jump), 1e-4 * 0.5 * (before + steps), 1e-9);
}

TEST(SolveInterval, WhatGoesOnMayDoSoForHalfAsLongAsWhatIsHeld) {
  Host growing([](double t) { return 0.1 + 1e-4 * t; });
  growing.most = 40;
  growing.run(2000);
  EXPECT_EQ(growing.interval.steps(), 20);
  Host still([](double) { return 0.5; });
  still.most = 40;
  still.run(2000);
  EXPECT_EQ(still.interval.steps(), 40);
}

TEST(SolveInterval, AJumpAndOtherGrainsAreSolvedForOftenAgain) {
  Host host([](double t) { return t < 5000.0 ? 0.5 : 0.8; });
  host.run(5000);
  const int before = host.interval.steps();
  host.run(1200, 5000);
  EXPECT_GT(host.interval.largest_error(), 0.2);
  host.interval.restart();
  EXPECT_EQ(host.interval.steps(), 1);
  EXPECT_GT(before, 100);
  Host other([](double) { return 0.5; });
  other.run(2000);
  other.ids = pfv::Packing::Ids::LinSpaced(3, 1, 3);
  other.take(0.5, 10);
  EXPECT_EQ(other.interval.steps(), 1);
}

TEST(SolveInterval, WithoutAnyLoadNothingIsDividedByZero) {
  Host nothing([](double) { return 0.0; });
  nothing.run(100);
  EXPECT_TRUE(std::isfinite(nothing.interval.error()));
  EXPECT_TRUE(nothing.interval.held().slope.allFinite());
}

}  // namespace
}  // namespace solve_interval_test
