// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace pfv::detail {

/// Whether `path` cannot be replaced by another file: a device, a pipe, or the very file that
/// standard output or standard error goes to (/dev/stdout).
bool is_stream(const std::string& path);
bool is_standard_output(const std::string& path);

/// What makes the file at `path` hold exactly what is put into it, or leaves it as it was: a temporary file in the same
/// folder, which `finish` renames. A stream is written straight to. All throw FileError.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void put(std::string_view content);
  void finish();

 private:
  [[noreturn]] void fail(int error);

  std::string path_, target_, temporary_;  // of a stream the last two are empty
  int file_ = -1;
};

void write_file(const std::string& path, std::string_view content);

/// Removes a file, or a link to one, that an earlier run has left at `path`; anything else stays. Throws FileError.
void remove_file(const std::string& path);

}  // namespace pfv::detail
