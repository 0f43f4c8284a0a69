// SPDX-License-Identifier: GPL-3.0-or-later
// A program that has started MPI for one thread: what needs two is refused.
#include "pfv/flow.hpp"
#include "pfv/mpi.hpp"

#include <cstdio>
#include <exception>
#include <mpi.h>

int main(int argc, char** argv) {
  int threads = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SINGLE, &threads);
  pfv::Options options;
  options.solver = pfv::SolverKind::amg;
  options.rebuild_lag = 3;
  try {
    pfv::Flow(pfv::Box{}, pfv::Fluid{}, options, pfv::ranks_of(MPI_COMM_WORLD));
    std::puts("taken");
  } catch (const std::exception& error) {
    std::puts(error.what());
  }
  MPI_Finalize();
}
