// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <memory>

namespace pfv {

/// Threads that share work which is cut into parts. The cut never depends on how many there are, or
/// does so only where parts do not touch: same bytes for any number of threads. A team of one starts
/// no thread.
class Team {
 public:
  /// `threads` >= 1, the caller's among them.
  explicit Team(int threads = 1);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const { return threads_; }

  /// Calls work(part) for each part in 0 ... parts - 1, each thread taking the next part that is left;
  /// returns when all are done. Throws what one has thrown.
  template <class Work>
  void run(int parts, const Work& work) {
    run_parts(parts, [](const void* context, int part) {
      (*static_cast<const Work*>(context))(part);
    }, &work);
  }

  /// The same with work(part, thread), thread 0 ... threads() - 1: for work space, one a thread.
  template <class Work>
  void run_with_space(int parts, const Work& work) {
    std::atomic<int> next{0};
    run(threads_, [&](int thread) {
      for (int part; (part = next.fetch_add(1, std::memory_order_relaxed)) < parts;)
        work(part, thread);
    });
  }

  /// Calls work(begin, end) on pieces of 0 ... rows - 1, one a thread, of about equal numbers of
  /// entries; row r has the entries row_begin[r] ... row_begin[r + 1] - 1.
  template <class Work>
  void run_rows(const int* row_begin, int rows, const Work& work) {
    if (threads_ == 1) return work(0, rows);
    run(threads_, [&](int part) {
      work(first_row(row_begin, rows, part), first_row(row_begin, rows, part + 1));
    });
  }

 private:
  using Call = void (*)(const void* context, int part);
  void run_parts(int parts, Call call, const void* context);
  int first_row(const int* row_begin, int rows, int part) const;

  struct Workers;
  int threads_;
  std::unique_ptr<Workers> workers_;  ///< null for a team of one
};

}  // namespace pfv
