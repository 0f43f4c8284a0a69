// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve/linear_solver.hpp"

#include <memory>

namespace pfv {

/// A direct solver behind Amesos2 on a Tpetra matrix, on the calling rank alone: it talks to no
/// other rank and needs no MPI_Init. The solver must be resolved and take the ordering.
std::unique_ptr<LinearSolver> make_amesos2_solver(SolverKind solver, OrderingKind ordering,
                                                  Precision precision,
                                                  std::shared_ptr<Team> team);

}  // namespace pfv
