// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers as messages have them.
#include "pfv/words.hpp"
#include "text/number_text.hpp"

#include <gtest/gtest.h>

namespace text_test {
namespace {

TEST(Text, PercentHasNoExponentWhereItIsLarge) {
  using pfv::detail::percent_text;
  EXPECT_EQ(percent_text(0.0704), "7 %");
  EXPECT_EQ(percent_text(0.00021), "0.021 %");
  EXPECT_EQ(percent_text(0.994), "99 %");
  EXPECT_EQ(percent_text(0.9999), "100 %");
  EXPECT_EQ(percent_text(12.34), "1234 %");
}

TEST(Text, NamesLikeAWord) {
  const std::vector<std::string> names{"viscosity", "density", "solver", "face", "patch"};
  EXPECT_EQ(pfv::meant_by("viscocity", names), "; is viscosity meant?");
  EXPECT_EQ(pfv::meant_by("densty", names), "; is density meant?");
  EXPECT_EQ(pfv::meant_by("faces", names), "; is face meant?");
  EXPECT_EQ(pfv::meant_by("slover", names), "; is solver meant?");
  EXPECT_EQ(pfv::meant_by("--faces", {"--forces", "--solver", "--face"}), "; is --face or --forces meant?");
  EXPECT_EQ(pfv::meant_by("colour", names), "");
  EXPECT_EQ(pfv::meant_by("", names), "");
}

}  // namespace
}  // namespace text_test
