// SPDX-License-Identifier: GPL-3.0-or-later
// What long steps expect of the pressures to come.
#include "coupling/pressure_lag.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using pfv::PressureLag;

Eigen::VectorXd ramp(int step) { return Eigen::Vector2d(3.0 + 0.5 * step, -2.0 * step); }

constexpr double prompt_limits = 30.0;

PressureLag after(int steps, double limits) {
  PressureLag lag;
  lag.relax(limits, prompt_limits);
  lag.start_from(ramp(0));
  for (int step = 1; step <= steps; ++step) lag.follow(ramp(step));
  return lag;
}

TEST(PressureLag, MeetsPressuresThatChangeEvenlyUpToTwentyLimits) {
  for (const double limits : {1.0, 20.0}) {
    EXPECT_EQ(after(0, limits).expected(), ramp(0));
    EXPECT_EQ(after(2, limits).expected(), ramp(3));
    EXPECT_EQ(after(50, limits).expected(), ramp(51));
  }
}

TEST(PressureLag, BeyondLessOfTheTrendIsExpected) {
  const PressureLag lag = after(50, 25.0);
  const double trend = std::pow(20.0 / 25.0, 4);
  EXPECT_EQ(lag.level, ramp(50));
  EXPECT_EQ(lag.expected(), ramp(50) + trend * (ramp(51) - ramp(50)));
}

TEST(PressureLag, BeyondThePromptLimitsItTrailsByTheRatioOfThem) {
  for (const double limits : {60.0, 300.0, 3000.0}) {
    const double part = prompt_limits / limits, steps_behind = 1.0 / part - 1.0;
    const PressureLag lag = after(static_cast<int>(40.0 / part), limits);
    const Eigen::VectorXd now = ramp(static_cast<int>(40.0 / part));
    const Eigen::Vector2d slope(0.5, -2.0);
    EXPECT_LT((now - lag.level - steps_behind * slope).norm(), 1e-9 * now.norm()) << limits;
    EXPECT_LT((lag.level - lag.delayed - slope / part).norm(), 1e-9 * now.norm()) << limits;
    const double trend = std::pow(20.0 / limits, 4);
    EXPECT_LT((lag.expected() - lag.level - trend * slope / part).norm(), 1e-9 * now.norm())
        << limits;
  }
}

TEST(PressureLag, ForgottenItIsEmpty) {
  PressureLag lag = after(3, 10.0);
  EXPECT_FALSE(lag.empty());
  lag.forget();
  EXPECT_TRUE(lag.empty());
}

}  // namespace
