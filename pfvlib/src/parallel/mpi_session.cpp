// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/mpi_session.hpp"

#include <mpi.h>

namespace pfv {

void MpiSession::start() { static const MpiSession session; }

bool MpiSession::takes_threads() {
  int provided = MPI_THREAD_SINGLE;
  MPI_Query_thread(&provided);
  return provided == MPI_THREAD_MULTIPLE;
}

MpiSession::MpiSession() {
  int is_initialized = 0;
  MPI_Initialized(&is_initialized);
  if (is_initialized) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
  is_ours_ = true;
}

MpiSession::~MpiSession() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (is_ours_ && !is_over) MPI_Finalize();
}

}  // namespace pfv
