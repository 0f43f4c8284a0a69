// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>

namespace pfv {

/// Of the solver libraries and the BLAS below them, which one thread at a time is in, whichever flow it solves:
/// Trilinos counts references without atomic operations, hypre has random numbers of the process, both ask MPI, and two threads
/// in Debian's openblas-serial get wrong factors.
inline std::mutex libraries_mutex;

}  // namespace pfv
