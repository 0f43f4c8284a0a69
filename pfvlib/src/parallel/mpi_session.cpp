// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/mpi_session.hpp"

#include <mpi.h>
#include <cstdlib>
#include <utility>
#include <vector>

namespace pfv {

namespace {

/// Keeps Open MPI, while it starts, from looking for networks and from a daemon, which a program alone has no use for and
/// which take it 0.4 s. What the user has set stays.
class Alone {
 public:
  Alone() {
    for (const auto& [name, value] : wishes)
      if (!std::getenv(name) && setenv(name, value, 0) == 0) set_.push_back(name);
  }
  ~Alone() {
    for (const char* name : set_) unsetenv(name);
  }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  static constexpr std::pair<const char*, const char*> wishes[]{
      {"OMPI_MCA_ess_singleton_isolated", "1"}, {"OMPI_MCA_pml", "ob1"}, {"OMPI_MCA_btl", "self"}};
  std::vector<const char*> set_;
};

void start_for_several_threads() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
}

}  // namespace

bool MpiSession::is_launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

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
  if (is_launched()) {
    start_for_several_threads();
  } else {
    const Alone alone;
    start_for_several_threads();
  }
  is_ours_ = true;
}

MpiSession::~MpiSession() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (is_ours_ && !is_over) MPI_Finalize();
}

}  // namespace pfv
