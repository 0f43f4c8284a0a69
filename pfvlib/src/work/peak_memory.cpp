// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/peak_memory.hpp"

#include <sys/resource.h>

#include <fstream>
#include <string>

namespace pfv {

/// getrusage has the memory of the process before exec as well, that of a large program which started this one;
/// Linux' own mark (VmHWM, kB) begins with the program.
std::int64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (std::int64_t kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace pfv
