// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that share work: every part once, whatever their number.
#include "parallel/team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace team_test {
namespace {

TEST(Team, DoesEachPartOnce) {
  for (const int threads : {1, 2, 3}) {
    pfv::Team team(threads);
    for (int round = 0; round < 200; ++round) {
      const int parts = round % 7;
      std::vector<int> done(parts, 0);
      team.run(parts, [&](int part) { ++done[part]; });
      EXPECT_EQ(done, std::vector<int>(parts, 1)) << threads << " threads, " << parts << " parts";
    }
  }
}

TEST(Team, HasThreadsOfItsOwn) {
  pfv::Team team(2);
  std::atomic<int> arrived{0};
  // each part waits for the other: one thread alone would never end
  team.run(2, [&](int) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

TEST(Team, CutsRowsIntoPiecesThatCoverThemOnce) {
  const std::vector<int> row_begin{5, 5, 90, 91, 91, 100, 140};
  const int rows = static_cast<int>(row_begin.size()) - 1;
  for (const int threads : {1, 2, 5, 9}) {
    pfv::Team team(threads);
    std::vector<int> done(rows, 0);
    team.run_rows(row_begin.data(), rows, [&](int first, int last) {
      for (int row = first; row < last; ++row) ++done[row];
    });
    EXPECT_EQ(done, std::vector<int>(rows, 1)) << threads << " threads";
    const int none = 0;
    team.run_rows(&none, 0, [&](int first, int last) { EXPECT_EQ(first, last); });
  }
}

TEST(Team, PassesOnWhatAPartHasThrownAndGoesOn) {
  for (const int threads : {1, 3}) {
    pfv::Team team(threads);
    EXPECT_THROW(team.run(8, [](int part) {
      if (part == 5) throw std::runtime_error("part 5");
    }), std::runtime_error);
    std::atomic<int> done{0};
    team.run_with_space(8, [&](int, int thread) { done += thread < threads; });
    EXPECT_EQ(done, 8) << threads << " threads";
  }
}

}  // namespace
}  // namespace team_test
