// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the tests of a program, or with `--file SUBJECT` those of SUBJECT_test.cpp: one process for a file, since
// to load the libraries takes longer than most tests.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace {

/// "Suite.Test:Suite.Other" of a file.
std::string tests_of(const std::string& subject) {
  const std::string file = "/" + subject + "_test.cpp";
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      const std::string source = test.file();
      if (source.size() >= file.size() && source.compare(source.size() - file.size(), file.size(), file) == 0)
        filter += (filter.empty() ? "" : ":") + std::string(suite.name()) + "." + test.name();
    }
  }
  return filter;
}

}  // namespace

int main(int count, char** words) {
  testing::InitGoogleTest(&count, words);
  if (count == 3 && words[1] == std::string("--file")) {
    const std::string filter = tests_of(words[2]);
    if (filter.empty()) {
      std::fprintf(stderr, "there is no test in %s_test.cpp\n", words[2]);
      return 2;
    }
    testing::GTEST_FLAG(filter) = filter;
  } else if (count > 1) {
    std::fprintf(stderr, "unknown: %s; give --file SUBJECT, or flags of googletest\n", words[1]);
    return 2;
  }
  return RUN_ALL_TESTS();
}
