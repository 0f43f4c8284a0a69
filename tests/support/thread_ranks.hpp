// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace support {

/// Ranks that are threads of one program, for what needs no MPI.
class ThreadRanks final : public pfv::Ranks {
 public:
  /// What they have in common.
  struct Meeting {
    explicit Meeting(int ranks) : count(ranks), sent(ranks) {}

    int count, waiting = 0, turn = 0;
    bool left = false;  // one has gone, and none may wait for it
    std::vector<std::vector<Bytes>> sent;
    std::mutex mutex;
    std::condition_variable change;

    void wait() {
      std::unique_lock lock(mutex);
      const int own_turn = turn;
      if (++waiting == count) {
        waiting = 0;
        ++turn;
        change.notify_all();
      }
      change.wait(lock, [&] { return turn != own_turn || left; });
      if (turn == own_turn) throw std::logic_error("another rank does not come");
    }
    void leave() {
      const std::lock_guard lock(mutex);
      left = true;
      change.notify_all();
    }
  };

  ThreadRanks(Meeting& meeting, int own) : meeting_(&meeting), own_(own) {}
  int count() const override { return meeting_->count; }
  int own() const override { return own_; }
  void add(double* values, std::size_t size) const override {
    combine(values, size, [](double a, double b) { return a + b; });
  }
  void take_largest(double* values, std::size_t size) const override {
    combine(values, size, [](double a, double b) { return std::max(a, b); });
  }
  std::vector<Bytes> hand_over(const std::vector<Bytes>& to) const override {
    meeting_->sent[own_] = to;
    meeting_->wait();
    std::vector<Bytes> from;
    for (const std::vector<Bytes>& other : meeting_->sent) from.push_back(other[own_]);
    meeting_->wait();
    return from;
  }
  void exchange(const std::vector<std::vector<double>>&, std::vector<std::vector<double>>&) const override {
    throw std::logic_error("is not needed yet");
  }
  std::shared_ptr<const pfv::Ranks> beside() const override { throw std::logic_error("is not needed yet"); }

 private:
  template <class Combine>
  void combine(double* values, std::size_t size, const Combine& combine) const {
    Bytes own;
    pfv::append(own, values, size);
    const std::vector<Bytes> all = gather(own);
    for (std::size_t r = 0; r < all.size(); ++r) {
      const std::vector<double> part = pfv::values_in<double>(all[r]);
      for (std::size_t k = 0; k < size; ++k) values[k] = r == 0 ? part[k] : combine(values[k], part[k]);
    }
  }

  Meeting* meeting_;
  int own_;
};

/// Does it on so many ranks at once. What one throws and `work` does not catch lets the others go.
inline void on_threads(int count, const std::function<void(const pfv::Ranks&)>& work) {
  ThreadRanks::Meeting meeting(count);
  std::vector<std::thread> threads;
  for (int r = 0; r < count; ++r)
    threads.emplace_back([&, r] {
      const ThreadRanks ranks(meeting, r);
      work(ranks);
      meeting.leave();
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace support
