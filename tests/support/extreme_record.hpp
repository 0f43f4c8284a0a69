// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace support {

/// Keeps the largest mass and force-balance errors of the running test in its report, where
/// doc/extremes.py reads them.
inline void record_balances(const pfv::Report& report) {
  static const testing::TestInfo* running = nullptr;
  static double mass = 0.0, force = 0.0;
  const testing::TestInfo* now = testing::UnitTest::GetInstance()->current_test_info();
  if (now != running) mass = force = 0.0;
  running = now;
  mass = std::max(mass, std::abs(report.mass_error));
  force = std::max(force, report.force_balance_error);
  const auto text = [](double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  };
  testing::Test::RecordProperty("mass_error", text(mass));
  testing::Test::RecordProperty("force_error", text(force));
}

}  // namespace support
