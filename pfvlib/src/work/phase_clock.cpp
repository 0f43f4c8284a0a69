// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/phase_clock.hpp"

#include <algorithm>
#include <mutex>
#include <pthread.h>
#include <vector>

namespace pfv {

namespace {

double read(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The threads of the process that work in the background.
struct Background {
  std::mutex mutex;
  std::vector<clockid_t> running;
  double ended = 0.0;  ///< CPU seconds of those that are done
};

Background& background() {
  static Background threads;
  return threads;
}

thread_local bool is_background = false;

}  // namespace

double cpu_seconds() {
  if (is_background) return read(CLOCK_THREAD_CPUTIME_ID);
  Background& others = background();
  const std::lock_guard<std::mutex> lock(others.mutex);
  double seconds = read(CLOCK_PROCESS_CPUTIME_ID) - others.ended;
  for (const clockid_t clock : others.running) seconds -= read(clock);
  return seconds;
}

double wall_seconds() { return read(CLOCK_MONOTONIC); }

BackgroundWork::BackgroundWork() {
  pthread_getcpuclockid(pthread_self(), &clock_);
  Background& others = background();
  const std::lock_guard<std::mutex> lock(others.mutex);
  others.running.push_back(clock_);
  is_background = true;
}

BackgroundWork::~BackgroundWork() {
  Background& others = background();
  const std::lock_guard<std::mutex> lock(others.mutex);
  others.running.erase(std::find(others.running.begin(), others.running.end(), clock_));
  others.ended += read(CLOCK_THREAD_CPUTIME_ID);
  is_background = false;
}

}  // namespace pfv
