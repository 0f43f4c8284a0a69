// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_source.hpp"

#include "parallel/one_rank.hpp"
#include "pfv/error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace pfv::detail {
namespace {

constexpr std::size_t block = std::size_t{1} << 18;  // characters that are held at a time

[[noreturn]] void fail_to_read(const std::string& path, const std::string& why) {
  throw InputError("cannot read packing " + detail::quoted(path) + ": " + why +
                   ": give a table, a LIGGGHTS dump or data file, or points of a VTK file");
}

using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

std::size_t read_packed(const std::string& path, gzFile file, char* to, std::size_t count) {
  const int got = gzread(file, to, static_cast<unsigned>(std::min<std::size_t>(count, 1u << 30)));
  int problem = Z_OK;
  const std::string why = gzerror(file, &problem);
  if (problem == Z_ERRNO) fail_to_read(path, std::strerror(errno));  // a folder, for one
  if (problem == Z_BUF_ERROR) fail_to_read(path, "the packed file is cut off");
  if (got < 0) fail_to_read(path, "it cannot be unpacked (" + why + ")");
  return static_cast<std::size_t>(got);
}

/// In memory.
class HeldText final : public TextSource {
 public:
  HeldText(const std::string& path, gzFile file) : TextSource(path) {
    std::string piece(block, ' ');
    while (const std::size_t got = read_packed(path, file, piece.data(), piece.size())) text_.append(piece, 0, got);
  }

 private:
  std::size_t read_stored(std::size_t begin, char* to, std::size_t count) override {
    return std::string_view(text_).substr(std::min(begin, text_.size())).copy(to, count);
  }
  std::size_t stored_size() override { return text_.size(); }
  std::string take_stored() override { return std::move(text_); }

  std::string text_;
};

/// A file as it is.
class PlainText final : public TextSource {
 public:
  explicit PlainText(const std::string& path) : TextSource(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) fail(std::strerror(errno));
  }
  ~PlainText() override { ::close(file_); }
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

 private:
  std::size_t read_stored(std::size_t begin, char* to, std::size_t count) override {
    std::size_t all = 0;
    while (all < count) {
      const ssize_t got = ::pread(file_, to + all, count - all, static_cast<off_t>(begin + all));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(std::strerror(errno));
      if (got == 0) break;
      all += static_cast<std::size_t>(got);
    }
    return all;
  }
  std::size_t stored_size() override {
    struct stat state;
    if (::fstat(file_, &state) != 0) fail(std::strerror(errno));
    return static_cast<std::size_t>(state.st_size);
  }

  int file_;
};

/// A file packed with gzip, which is unpacked again from its beginning for what stands before the last part.
class PackedText final : public TextSource {
 public:
  PackedText(const std::string& path, GzFile file) : TextSource(path), file_(std::move(file)) {}

 private:
  std::size_t read_stored(std::size_t begin, char* to, std::size_t count) override {
    if (begin != place_ && gzseek(file_.get(), static_cast<z_off_t>(begin), SEEK_SET) < 0)
      fail("it cannot be unpacked again");
    place_ = begin;
    std::size_t all = 0;
    for (std::size_t got = 1; got > 0 && all < count; all += got)
      got = read_packed(path(), file_.get(), to + all, count - all);
    place_ += all;
    return all;
  }
  std::size_t stored_size() override {
    std::string text(block, ' ');
    std::size_t all = 0;
    for (std::size_t got = block; got == block; all += got) got = read_stored(all, text.data(), block);
    return all;
  }

  GzFile file_;
  std::size_t place_ = 0;
};

bool is_of(const std::string& path, mode_t kind) {
  struct stat state;
  return ::stat(path.c_str(), &state) == 0 && (state.st_mode & S_IFMT) == kind;
}

}  // namespace

// ------------------------------------------------------------------------------------------ sources

void TextSource::fail(const std::string& why) const { fail_to_read(path_, why); }

std::size_t TextSource::read(std::size_t begin, char* to, std::size_t count) {
  const std::size_t got = read_stored(skipped_ + begin, to, count);
  if (old_mac_) std::replace(to, to + got, '\r', '\n');
  return got;
}

std::string TextSource::part(std::size_t begin, std::size_t count) {
  std::string text(std::min(count, size_ - std::min(begin, size_)), ' ');
  text.resize(read(begin, text.data(), text.size()));
  return text;
}

std::string TextSource::take_stored() {
  std::string text(skipped_ + size_, ' ');
  text.resize(read_stored(0, text.data(), text.size()));
  return text;
}

std::string TextSource::take() {
  std::string text = take_stored();
  text.erase(0, skipped_);
  if (old_mac_) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

void TextSource::look(const Ranks& ranks) {
  double stored = 0.0;
  ranks.together([&] {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (part(0, byte_order_mark.size()) == byte_order_mark) skipped_ = byte_order_mark.size();
    struct stat state {};
    if (ranks.count() > 1 && ::stat(path_.c_str(), &state) == 0) stored = static_cast<double>(state.st_size);
    if (ranks.own() == 0) size_ = stored_size() - skipped_;
    bool ends = false, more = true;
    constexpr std::size_t long_line = 4096;
    for (std::size_t begin = 0; !ends && more; begin += long_line) {
      const std::string text = part(begin, long_line);
      ends = text.find('\n') != std::string::npos;
      more = text.size() == long_line;
    }
    old_mac_ = !ends;  // or one line
  });
  const bool unlike = ranks.largest(stored) != -ranks.largest(-stored);
  ranks.together([&] {
    if (unlike)
      throw InputError(path_ + ": its size is not the same for all ranks: give a file that all of them see and that nothing "
                       "writes to");
  });
  Ranks::Bytes bytes;
  append(bytes, &size_, 1);
  size_ = values_in<std::size_t>(told_by_first(ranks, bytes))[0];
}

std::unique_ptr<TextSource> open_text(const std::string& path, const Ranks& ranks) {
  std::unique_ptr<TextSource> source;
  ranks.together([&] {
    GzFile file(gzopen(path.c_str(), "rb"), &gzclose);
    if (!file) fail_to_read(path, std::strerror(errno));
    const bool regular = is_of(path, S_IFREG), shared = ranks.count() > 1;
    if (shared && !regular && !is_of(path, S_IFDIR))
      throw InputError(path + ": several ranks read parts of a file, and this is a pipe or a device: write it to a file first");
    if (regular && gzdirect(file.get()))
      source = std::make_unique<PlainText>(path);
    else if (shared && regular)
      source = std::make_unique<PackedText>(path, std::move(file));
    else
      source = std::make_unique<HeldText>(path, file.get());  // of a folder there is none
  });
  source->look(ranks);
  return source;
}

// -------------------------------------------------------------------------------------------- parts

namespace {

/// A part of a source, block by block.
class Blocks {
 public:
  Blocks(TextSource& source, const TextPart& part) : source_(&source), next_(part.begin), end_(part.end) {}

  std::string_view more(std::string_view rest) {
    const std::size_t kept = rest.size();
    if (kept > 0) std::memmove(held_.data(), rest.data(), kept);
    held_.resize(std::max(held_.size(), kept + std::min(block, end_ - next_)));
    const std::size_t got = source_->read(next_, held_.data() + kept, std::min(held_.size() - kept, end_ - next_));
    next_ += got;
    return std::string_view(held_).substr(0, kept + got);
  }

 private:
  TextSource* source_;
  std::size_t next_, end_;
  std::string held_;
};

/// Calls take(text) for one block after the other until it returns false.
template <class Take>
void for_each_block(TextSource& source, std::size_t begin, std::size_t end, const Take& take) {
  std::string text(std::min(block, end - begin), ' ');
  while (begin < end) {
    const std::size_t got = source.read(begin, text.data(), std::min(text.size(), end - begin));
    if (got == 0 || !take(std::string_view(text).substr(0, got))) return;
    begin += got;
  }
}

std::size_t count_line_ends(TextSource& source, std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  for_each_block(source, begin, end, [&](std::string_view text) {
    count += static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    return true;
  });
  return count;
}

/// Where the first line of a part begins that does not begin before `place`.
std::size_t line_from(TextSource& source, std::size_t place, const TextPart& part) {
  if (place <= part.begin) return part.begin;
  std::size_t begin = place - 1;
  bool found = false;
  for_each_block(source, begin, part.end, [&](std::string_view text) {
    const std::size_t end = text.find('\n');
    found = end != std::string_view::npos;
    begin += found ? end + 1 : text.size();
    return !found;
  });
  return found ? begin : part.end;
}

}  // namespace

TextLines lines_of(TextSource& source, const TextPart& part) {
  const auto blocks = std::make_shared<Blocks>(source, part);
  return {source.path(), [blocks](std::string_view rest) { return blocks->more(rest); }, part.lines_before};
}

LineShare share_of_lines(TextSource& source, const TextPart& part, const Ranks& ranks) {
  LineShare share;
  const auto place = [&](int rank) {
    const std::size_t size = part.end - part.begin, count = static_cast<std::size_t>(ranks.count());
    return part.begin + size / count * static_cast<std::size_t>(rank) + size % count * static_cast<std::size_t>(rank) / count;
  };
  ranks.together([&] {
    share.own.begin = line_from(source, place(ranks.own()), part);
    const std::size_t next = std::max(share.own.begin, place(ranks.own() + 1));
    share.own.end = next;
    if (next == share.own.begin) return;
    // in the order of the text: a packed one is unpacked once for both
    share.lines = count_line_ends(source, share.own.begin, next - 1) + 1;
    share.own.end = line_from(source, next, part);
  });
  Ranks::Bytes bytes;
  append(bytes, &share.lines, 1);
  const std::vector<Ranks::Bytes> all = ranks.gather(bytes);
  for (int r = 0; r < ranks.count(); ++r) {
    const std::size_t lines = values_in<std::size_t>(all[r])[0];
    if (r < ranks.own()) share.first += lines;
    share.all += lines;
  }
  share.own.lines_before = part.lines_before + share.first;
  share.last = share.own.end == part.end;
  return share;
}

}  // namespace pfv::detail
