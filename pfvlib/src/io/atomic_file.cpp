// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"

#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace pfv {
namespace {

namespace fs = std::filesystem;

int write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Whether both names lead to one file; works for pipes and devices too.
bool is_same(const char* one, const char* other) {
  struct stat a, b;
  return ::stat(one, &a) == 0 && ::stat(other, &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Follows a symbolic link, so that renaming replaces the file and not the link.
std::string target_of(const std::string& path) {
  std::error_code none;
  const fs::path target = fs::canonical(path, none);
  return none ? path : target.string();
}

std::string temporary_beside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const std::string name =
      ".pfv-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".part";
  return (folder_of(path) / name).string();
}

}  // namespace

bool detail::is_standard_output(const std::string& path) {
  return is_same(path.c_str(), "/dev/stdout");
}

bool detail::is_stream(const std::string& path) {
  std::error_code none;
  return fs::is_other(fs::status(path, none)) || is_standard_output(path) ||
         is_same(path.c_str(), "/dev/stderr");
}

namespace detail {

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  if (!is_stream(path)) {
    target_ = target_of(path);
    temporary_ = temporary_beside(target_);
  }
  const bool stream = temporary_.empty();
  file_ = ::open((stream ? path_ : temporary_).c_str(), O_WRONLY | O_CLOEXEC | (stream ? O_APPEND : O_CREAT | O_EXCL), 0666);
  if (file_ >= 0) return;
  const int error = errno;
  temporary_.clear();  // whosever it is
  fail(error);
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::put(std::string_view content) {
  if (const int error = write_all(file_, content)) fail(error);
}

void AtomicFile::finish() {
  // A network disk may report that it is full only here.
  if (::close(std::exchange(file_, -1)) != 0) fail(errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void AtomicFile::fail(int error) {
  throw FileError("cannot write " + path_ + ": " + std::strerror(error) + ": free space or choose another place");
}

void write_file(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  file.put(content);
  file.finish();
}

}  // namespace detail

void detail::remove_file(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none) || is_stream(path)) return;
  if (::unlink(path.c_str()) != 0 && errno != ENOENT)
    throw FileError("cannot remove " + path + " of another run: " + std::strerror(errno) +
                    ": remove it or choose another place");
}

void write_text(const std::string& path, const std::string& text) { detail::write_file(path, text); }

void require_folder_of(const std::string& path) {
  if (path.empty()) throw InputError("an output file has no name: give one");
  if (detail::is_stream(path)) return;
  std::error_code none;
  if (fs::is_directory(path, none) || path.back() == '/')
    throw InputError("output " + path + " is a folder: give the name of a file in it");
  const fs::path folder = folder_of(path);
  if (!fs::is_directory(folder, none))
    throw InputError("output folder " + folder.string() + " is not there: make it first");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError("output folder " + folder.string() +
                     " cannot be written: choose another one");
}

}  // namespace pfv
