// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace pfv::detail {

inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// A piece of a file for an error message: short, printable and on one line.
inline std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string quote = "'";
  for (const char c : text.substr(0, longest)) quote += c >= ' ' && c <= '~' ? c : '?';
  return quote + (text.size() > longest ? "...'" : "'");
}

/// The lines of a text one after the other, without surrounding blanks, and where we are.
class TextLines {
 public:
  TextLines(std::string file, std::string_view text, std::size_t lines_before = 0)
      : file_(std::move(file)), rest_(text), number_(lines_before) {}

  /// Steps to the next line; false at the end.
  bool next() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    ended_ = end != std::string_view::npos;
    line_ = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }
  /// Steps to the next line that is not blank; false at the end.
  bool next_filled() {
    while (next())
      if (!line_.empty()) return true;
    return false;
  }

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }
  /// False for a last line that nothing ends, as where the file is cut off.
  bool ended() const { return ended_; }
  std::string place() const { return file_ + ":" + std::to_string(number_) + ": "; }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(place() + what); }

 private:
  std::string file_;
  std::string_view rest_, line_;
  std::size_t number_;
  bool ended_ = true;
};

/// Splits at every `separator` and trims; into `fields`, whose memory is used again.
inline void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// Splits at runs of blanks.
inline void split_words(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = line.find_first_of(" \t");
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end == std::string_view::npos ? line.size() : end);
  }
}

}  // namespace pfv::detail
