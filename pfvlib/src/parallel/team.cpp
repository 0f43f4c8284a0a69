// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/team.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace pfv {

namespace {

/// How often a thread looks for its next work before it sleeps: some tens of microseconds, what
/// waking up costs.
constexpr int patience = 4000;

template <class Condition>
bool spin_until(const Condition& condition) {
  for (int look = 0; look < patience; ++look) {
    if (condition()) return true;
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }
  return false;
}

}  // namespace

struct Team::Workers {
  explicit Workers(int threads) : team(threads) {
    for (int thread = 1; thread < threads; ++thread)
      others.emplace_back([this] { serve(); });
  }

  ~Workers() {
    call = nullptr;
    announce();
    for (std::thread& other : others) other.join();
  }

  void announce() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      next.store(0, std::memory_order_relaxed);
      busy.store(team - 1, std::memory_order_relaxed);
      round.fetch_add(1, std::memory_order_release);
    }
    begun.notify_all();
  }

  void take_parts() {
    try {
      for (int part; (part = next.fetch_add(1, std::memory_order_relaxed)) < parts;)
        call(context, part);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!error) error = std::current_exception();
    }
  }

  void serve() {
    for (std::uint64_t seen = 0;; ++seen) {
      const auto more = [&] { return round.load(std::memory_order_acquire) != seen; };
      if (!spin_until(more)) {
        std::unique_lock<std::mutex> lock(mutex);
        begun.wait(lock, more);
      }
      if (!call) return;
      take_parts();
      if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) {
        const std::lock_guard<std::mutex> lock(mutex);
        finished.notify_one();
      }
    }
  }

  void wait() {
    const auto all_done = [&] { return busy.load(std::memory_order_acquire) == 0; };
    if (spin_until(all_done)) return;
    std::unique_lock<std::mutex> lock(mutex);
    finished.wait(lock, all_done);
  }

  const int team;
  Call call = nullptr;
  const void* context = nullptr;
  int parts = 0;
  std::exception_ptr error;
  std::atomic<std::uint64_t> round{0};
  std::atomic<int> busy{0}, next{0};
  std::mutex mutex;
  std::condition_variable begun, finished;
  std::vector<std::thread> others;
};

Team::Team(int threads) : threads_(std::max(1, threads)) {
  if (threads_ > 1) workers_ = std::make_unique<Workers>(threads_);
}

Team::~Team() = default;

void Team::run_parts(int parts, Call call, const void* context) {
  if (!workers_ || parts < 2) {
    for (int part = 0; part < parts; ++part) call(context, part);
    return;
  }
  workers_->call = call;
  workers_->context = context;
  workers_->parts = parts;
  workers_->announce();
  workers_->take_parts();
  workers_->wait();
  if (workers_->error) std::rethrow_exception(std::exchange(workers_->error, nullptr));
}

int Team::first_row(const int* row_begin, int rows, int part) const {
  const auto entries = static_cast<std::int64_t>(row_begin[rows]) - row_begin[0];
  const auto target = row_begin[0] + static_cast<int>(entries * part / threads_);
  if (part == threads_) return rows;
  return static_cast<int>(std::lower_bound(row_begin, row_begin + rows, target) - row_begin);
}

}  // namespace pfv
