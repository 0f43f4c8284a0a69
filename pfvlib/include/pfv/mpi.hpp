// SPDX-License-Identifier: GPL-3.0-or-later
// For programs that run on several ranks; those on one need neither this header nor MPI.
#pragma once

#include <memory>
#include <mpi.h>

namespace pfv {

class Ranks;

/// The ranks of a communicator, for Flow: each calls it with its own part of the packing. They talk in a duplicate of
/// it, which is freed with them (before MPI_Finalize). Null for a communicator of one rank: nothing is to be shared.
/// Collective.
std::shared_ptr<const Ranks> ranks_of(MPI_Comm communicator);

}  // namespace pfv
