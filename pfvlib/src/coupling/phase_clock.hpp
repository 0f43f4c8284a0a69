// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ctime>

namespace pfv {

/// CPU seconds of the process, all threads.
inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

inline double wall_seconds() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Adds the CPU time of its scope to a phase of the report.
class PhaseClock {
 public:
  explicit PhaseClock(double& seconds) : seconds_(seconds), start_(cpu_seconds()) {}
  ~PhaseClock() { seconds_ += cpu_seconds() - start_; }
  PhaseClock(const PhaseClock&) = delete;
  PhaseClock& operator=(const PhaseClock&) = delete;

 private:
  double& seconds_;
  double start_;
};

}  // namespace pfv
