// SPDX-License-Identifier: GPL-3.0-or-later
// liggghts-pfv: what the stock `liggghts` does, with `fix pfv`.
#include "input.h"
#include "lammps.h"
#include "signal_handling.h"

#include <mpi.h>
#include <csignal>

namespace {

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(signal, &action, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  namespace SignalHandler = LAMMPS_NS::SignalHandler;
  // the first SIGINT or SIGTERM ends the run after a restart file
  handle(SIGINT, SignalHandler::int_handler);
  handle(SIGTERM, SignalHandler::int_handler);
  handle(SIGUSR1, SignalHandler::usr1_handler);

  int threads = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &threads);  // for rebuild_lag on several ranks
  {
    LAMMPS_NS::LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    lammps.input->file();
  }
  MPI_Finalize();
}
