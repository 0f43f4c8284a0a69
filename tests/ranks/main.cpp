// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that several ranks take together: mpirun -n 4 ranks_tests. Every rank runs every test, and all fail where one
// does.
#include "world.hpp"

#include "pfv/mpi.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <mpi.h>
#include <sched.h>

namespace {

std::shared_ptr<const pfv::Ranks> all;

/// What fails is said by the rank where it does; what passes, by the first.
class Quiet : public testing::EmptyTestEventListener {
 public:
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed())
      std::printf("rank %d: %s:%d: %s\n", all->own(), result.file_name(), result.line_number(), result.message());
  }
};

/// Ranks that wait turn about: on a core of its own each would go on asking for messages, at the expense of whatever else
/// runs. A ./test.sh long has them on all cores.
void share_one_core() {
  cpu_set_t cores;
  if (in_long(true, false) || sched_getaffinity(0, sizeof cores, &cores) != 0) return;
  int last = CPU_SETSIZE - 1;
  while (last > 0 && !CPU_ISSET(last, &cores)) --last;
  CPU_ZERO(&cores);
  CPU_SET(last, &cores);
  sched_setaffinity(0, sizeof cores, &cores);
}

}  // namespace

std::shared_ptr<const pfv::Ranks> world() { return all; }

int main(int argc, char** argv) {
  share_one_core();
  int threads = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &threads);
  testing::InitGoogleTest(&argc, argv);
  all = pfv::ranks_of(MPI_COMM_WORLD);
  if (!all) {
    std::printf("run this with mpirun on two ranks or more\n");
    MPI_Finalize();
    return 2;
  }
  if (all->own() > 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new Quiet);
  }
  const bool failed = RUN_ALL_TESTS() != 0;
  const bool any = all->any(failed);
  all.reset();
  MPI_Finalize();
  return any ? 1 : 0;
}
