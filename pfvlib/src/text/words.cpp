// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/words.hpp"

#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace demands {
const Demand finite{"a finite number such as -1 or 2.5e-3", [](double x) { return std::isfinite(x); }};
const Demand positive{"a finite number > 0", [](double x) { return std::isfinite(x) && x > 0; }};
const Demand not_negative{"a finite number >= 0", [](double x) { return std::isfinite(x) && x >= 0; }};
const Demand positive_or_infinite{"a number > 0", [](double x) { return x > 0; }};
const Demand part{"a number above 0 and below 1", [](double x) { return x > 0 && x < 1; }};
const Demand percent{"a number above 0 and below 100", [](double x) { return x > 0 && x < 100; }};
const Demand count{"a whole number >= 1", [](double x) { return x >= 1; }};
const Demand flow_steps{"a whole number of flow steps >= 0", [](double x) { return x >= 0; }};
const Demand threads{"1 to 64", [](double x) { return x >= 1 && x <= 64; }};
}  // namespace demands

namespace {

/// How many letters must be put in, taken out, changed or exchanged with the next to make one of the other (Damerau).
std::size_t letters_apart(const std::string& one, const std::string& other) {
  std::vector<std::vector<std::size_t>> apart(one.size() + 1, std::vector<std::size_t>(other.size() + 1));
  for (std::size_t i = 0; i <= one.size(); ++i)
    for (std::size_t j = 0; j <= other.size(); ++j) {
      if (i == 0 || j == 0) {
        apart[i][j] = i + j;
        continue;
      }
      const std::size_t changed = apart[i - 1][j - 1] + (one[i - 1] != other[j - 1]);
      apart[i][j] = std::min({changed, apart[i - 1][j] + 1, apart[i][j - 1] + 1});
      if (i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1])
        apart[i][j] = std::min(apart[i][j], apart[i - 2][j - 2] + 1);
    }
  return apart.back().back();
}

}  // namespace

std::string meant_by(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t shown = 3;
  std::vector<std::pair<std::size_t, std::string>> like;
  for (const std::string& name : names)
    if (const std::size_t apart = letters_apart(word, name); 3 * apart <= std::max(word.size(), name.size()))
      like.emplace_back(apart, name);
  std::stable_sort(like.begin(), like.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  like.resize(std::min(like.size(), shown));
  std::string text;
  for (const auto& [apart, name] : like) text += (text.empty() ? "; is " : " or ") + name;
  return text.empty() ? text : text + " meant?";
}

std::string Words::keyword() {
  const std::string word = words_[next_++];
  subject_ = "keyword '" + word + "'";
  return word;
}

bool Words::take(const std::string& word) {
  if (done() || words_[next_] != word) return false;
  ++next_;
  return true;
}

bool Words::begins(const std::string& beginning) const {
  return !done() && words_[next_].rfind(beginning, 0) == 0;
}

bool Words::number_comes() const { return !done() && detail::finite_number(words_[next_]); }

std::string Words::word(const std::string& what) {
  if (done()) fail(what + " is missing");
  return words_[next_++];
}

double Words::number(const std::string& what, const Demand& demand) {
  const std::string text = word(what);
  const auto value = detail::finite_number(detail::trimmed(text));
  if (!value || !demand.met(*value)) fail(what + " is " + detail::quoted(text) + ": give " + demand.text);
  return *value;
}

int Words::whole_number(const std::string& what, const Demand& demand) {
  const std::string text = word(what);
  const auto value = detail::integer(detail::trimmed(text));
  if (!value || *value > std::numeric_limits<int>::max() || !demand.met(static_cast<double>(*value)))
    fail(what + " is " + detail::quoted(text) + ": give " + demand.text);
  return static_cast<int>(*value);
}

bool Words::yes_or_no() {
  const std::string text = word("yes or no");
  if (text != "yes" && text != "no") fail("say yes or no, not " + detail::quoted(text));
  return text == "yes";
}

int Words::axis() {
  const std::string text = word("the axis");
  if (text != "x" && text != "y" && text != "z") fail("the axis must be x, y or z, not " + detail::quoted(text));
  return text[0] - 'x';
}

void Words::fail(const std::string& what) const {
  throw InputError(subject_.empty() ? what : subject_ + ": " + what);
}

}  // namespace pfv
