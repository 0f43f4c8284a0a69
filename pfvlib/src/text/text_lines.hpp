// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"

#include <functional>
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
  /// What is left of a text's last piece, a part of a line, with the next piece behind it; no longer at the end.
  using More = std::function<std::string_view(std::string_view rest)>;

  TextLines(std::string file, std::string_view text, std::size_t lines_before = 0)
      : file_(std::move(file)), rest_(text), number_(lines_before) {}
  /// Of a text that comes in pieces: a line is there until the next one is asked for.
  TextLines(std::string file, More more, std::size_t lines_before)
      : file_(std::move(file)), more_(std::move(more)), number_(lines_before) {}

  /// Steps to the next line; false at the end.
  bool next() {
    const std::size_t end = find_end();
    if (rest_.empty()) return false;
    ended_ = end != std::string_view::npos;
    line_ = trimmed(rest_.substr(0, end));
    const std::size_t size = ended_ ? end + 1 : rest_.size();
    rest_.remove_prefix(size);
    begin_ = taken_;
    taken_ += size;
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
  /// Characters of the text before this line, and with it and its end.
  std::size_t begin() const { return begin_; }
  std::size_t taken() const { return taken_; }
  /// False for a last line that nothing ends, as where the file is cut off.
  bool ended() const { return ended_; }
  std::string place() const { return file_ + ":" + std::to_string(number_) + ": "; }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(place() + what); }

 private:
  std::size_t find_end() {
    std::size_t end = rest_.find('\n');
    while (end == std::string_view::npos && more_ && !all_) {
      const std::size_t known = rest_.size();
      rest_ = more_(rest_);
      all_ = rest_.size() == known;
      end = rest_.find('\n', known);
    }
    return end;
  }

  std::string file_;
  std::string_view rest_, line_;
  More more_;
  std::size_t number_, begin_ = 0, taken_ = 0;
  bool ended_ = true;
  bool all_ = false;  ///< no more comes
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
