// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a file piece by piece.
#pragma once

#include "parallel/ranks.hpp"
#include "text/text_lines.hpp"

#include <cstddef>
#include <memory>
#include <string>

namespace pfv::detail {

/// The text of a file, unpacked if it is packed with gzip, of which any part can be had without the others. A mark of byte
/// order before it is left out, and lines of an old Mac end like all others.
class TextSource {
 public:
  virtual ~TextSource() = default;
  /// Up to `count` characters from `begin` on, fewer only where the text ends. Throws InputError.
  std::size_t read(std::size_t begin, char* to, std::size_t count);
  std::string part(std::size_t begin, std::size_t count);  ///< the same
  /// All of it, which the source may not have afterwards.
  std::string take();
  std::size_t size() const { return size_; }
  const std::string& path() const { return path_; }

  /// Finds out how the text begins and, where there are several ranks, that all of them see the same file. Collective.
  void look(const Ranks& ranks);

 protected:
  explicit TextSource(std::string path) : path_(std::move(path)) {}
  [[noreturn]] void fail(const std::string& why) const;

 private:
  virtual std::size_t read_stored(std::size_t begin, char* to, std::size_t count) = 0;
  virtual std::size_t stored_size() = 0;
  virtual std::string take_stored();

  std::string path_;
  std::size_t skipped_ = 0, size_ = std::string::npos;
  bool old_mac_ = false;
};

/// Throws InputError where there is none that can be read. A text that can be read once only, or would have to be unpacked
/// again for each of its parts, is held whole by a program by itself. Collective.
std::unique_ptr<TextSource> open_text(const std::string& path, const Ranks& ranks);

/// A part of a text and the number of lines before it in the file.
struct TextPart {
  std::size_t begin = 0, end = 0, lines_before = 0;
};
/// Its lines, of which a block is held at a time. The source must live as long.
TextLines lines_of(TextSource& source, const TextPart& part);

/// The lines that this rank reads of a part: whole ones, about as many characters on each rank, those of rank 0 first.
struct LineShare {
  TextPart own;
  std::size_t lines = 0;  ///< how many
  std::size_t first = 0;  ///< lines of the part before them
  std::size_t all = 0;    ///< lines of the part
  bool last = false;      ///< the part's last line is among them, or no other could be
};
/// Collective.
LineShare share_of_lines(TextSource& source, const TextPart& part, const Ranks& ranks);

}  // namespace pfv::detail
