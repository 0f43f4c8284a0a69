// SPDX-License-Identifier: GPL-3.0-or-later
// What a program on several ranks sends, for doc/scaling.py: preloaded (LD_PRELOAD), it counts messages, bytes and sums over all
// ranks between the first and the last cycle of hypre's BoomerAMG, and writes them, with the number of cycles, to the file that
// PFV_MESSAGE_COUNT names when MPI ends. Of all ranks together: messages, bytes; of each: sums and cycles.
#include <HYPRE_parcsr_ls.h>
#include <dlfcn.h>
#include <mpi.h>
#include <cstdio>
#include <cstdlib>

namespace {

struct Counts {
  double messages = 0.0, bytes = 0.0, sums = 0.0;
};

Counts now, at_first, at_last;
double cycles = 0.0;

void count_message(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  now.messages += 1.0;
  now.bytes += static_cast<double>(count) * size;
}

void write(const Counts& between, int ranks) {
  const char* name = std::getenv("PFV_MESSAGE_COUNT");
  std::FILE* file = name ? std::fopen(name, "w") : nullptr;
  if (!file) return;
  std::fprintf(file, "{\"cycles\": %.0f, \"messages\": %.17g, \"bytes\": %.17g, \"sums\": %.17g}\n", cycles - 1.0, between.messages,
               between.bytes, between.sums / ranks);
  std::fclose(file);
}

}  // namespace

extern "C" {

HYPRE_Int HYPRE_BoomerAMGSolve(HYPRE_Solver solver, HYPRE_ParCSRMatrix matrix, HYPRE_ParVector b, HYPRE_ParVector x) {
  using Solve = HYPRE_Int (*)(HYPRE_Solver, HYPRE_ParCSRMatrix, HYPRE_ParVector, HYPRE_ParVector);
  static const auto solve = reinterpret_cast<Solve>(dlsym(RTLD_NEXT, "HYPRE_BoomerAMGSolve"));
  if (cycles == 0.0) at_first = now;
  at_last = now;
  cycles += 1.0;
  return solve(solver, matrix, b, x);
}

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm all, MPI_Request* request) {
  count_message(count, type);
  return PMPI_Isend(data, count, type, to, tag, all, request);
}

int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm all) {
  count_message(count, type);
  return PMPI_Send(data, count, type, to, tag, all);
}

int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op operation, MPI_Comm all) {
  now.sums += 1.0;
  return PMPI_Allreduce(from, to, count, type, operation, all);
}

int MPI_Finalize() {
  double between[3] = {at_last.messages - at_first.messages, at_last.bytes - at_first.bytes, at_last.sums - at_first.sums};
  double all[3] = {};
  int rank = 0, ranks = 1;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PMPI_Comm_size(MPI_COMM_WORLD, &ranks);
  PMPI_Reduce(between, all, 3, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  if (rank == 0) write({all[0], all[1], all[2]}, ranks);
  return PMPI_Finalize();
}

}  // extern "C"
