// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ctime>

namespace pfv {

/// CPU seconds of the process, all threads but those that work in the background; in one of these
/// its own.
double cpu_seconds();

double wall_seconds();

/// While it lives, the thread that has made it works in the background: see cpu_seconds. One a
/// thread.
class BackgroundWork {
 public:
  BackgroundWork();
  ~BackgroundWork();
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

 private:
  clockid_t clock_;
};

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
