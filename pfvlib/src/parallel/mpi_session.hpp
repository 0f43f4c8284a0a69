// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace pfv {

/// MPI for the libraries that cannot do without (MUMPS, hypre), to the end of the program; that of the
/// host program, where it has started one. A serial program needs no mpirun for it.
class MpiSession {
 public:
  static void start();
  /// By mpirun (Open MPI, MPICH and those like it) or a launcher that speaks PMIx.
  static bool is_launched();
  /// Whether several threads may be in MPI at once, which the host program decides where it has started it.
  static bool takes_threads();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

 private:
  MpiSession();
  bool is_ours_ = false;
};

}  // namespace pfv
