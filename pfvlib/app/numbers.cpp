// SPDX-License-Identifier: GPL-3.0-or-later
#include "numbers.hpp"

#include "pfv/error.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <cmath>

namespace pfv::app {

double number(const std::string& option, const std::string& text) {
  const auto value = detail::finite_number(detail::trimmed(text));
  if (!value)
    throw InputError(option + ": " + detail::quoted(text) + " is no finite number: give one such as -1 or 2.5e-3");
  return *value;
}

double positive(const std::string& option, const std::string& text) {
  const double value = number(option, text);
  if (value <= 0) throw InputError(option + ": " + text + " is not > 0: give a positive number");
  return value;
}

int whole_number(const std::string& option, const std::string& text, int least, int most) {
  const auto value = detail::finite_number(detail::trimmed(text));
  if (value && *value == std::floor(*value) && *value >= least && *value <= most)
    return static_cast<int>(*value);
  const std::string low = std::to_string(least), high = std::to_string(most);
  throw InputError(option + ": " + detail::quoted(text) + " is no whole number " +
                   (most < std::numeric_limits<int>::max() ? "from " + low + " to " + high : ">= " + low));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace pfv::app
