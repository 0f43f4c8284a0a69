// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace pfv::detail {

/// Reads the whole of `text` as a number: nothing before or after it but one leading plus sign.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

/// A finite number, or nothing: "inf", "nan" and what no double can hold are refused.
inline std::optional<double> finite_number(std::string_view text) {
  const std::optional<double> number = whole_number<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

inline std::optional<std::int64_t> integer(std::string_view text) {
  return whole_number<std::int64_t>(text);
}

/// Appends the shortest text that reads back as the same double; no minus sign before a zero.
inline void append_number(std::string& text, double number) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number + 0.0);
  text.append(buffer, result.ptr);
}

inline std::string number_text(double number) {
  std::string text;
  append_number(text, number);
  return text;
}

/// A part of 1 in per cent, for messages: two digits, and those before the point as they are (100, not 1e+02).
inline std::string percent_text(double part) {
  const double percent = 100.0 * part;
  char text[32];
  std::snprintf(text, sizeof text, percent >= 99.5 && percent < 1e9 ? "%.0f %%" : "%.2g %%", percent);
  return text;
}

}  // namespace pfv::detail
