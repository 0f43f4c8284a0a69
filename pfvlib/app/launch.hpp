// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/container.hpp"
#include "pfv/flow_model.hpp"
#include "pfv/packing.hpp"

#include <memory>
#include <optional>
#include <string>

namespace pfv {
class PackingParts;
}

namespace pfv::app {

/// The ranks that mpirun has started; null for a program by itself, which starts no MPI, and where the environment has
/// PFV_RANKS=one, as for programs that each do something of their own under one mpirun.
std::shared_ptr<const Ranks> launched_ranks();
/// Throws InputError on all ranks where they have not been given the same arguments. Collective.
void refuse_unlike_arguments(const Ranks& ranks, const std::string& arguments);
/// Whether this one writes files and talks.
bool speaks(const Ranks* ranks);
/// Ends all ranks where one has failed alone; returns where there is one only, or all know.
void end_others(const Ranks* ranks, int status);

/// The spheres of a packing file, on one rank or dealt out to several.
class DealtPacking {
 public:
  /// `rows`: those that this rank has read. Collective.
  DealtPacking(PackingArrays rows, const Container& container, const Ranks* ranks);
  ~DealtPacking();
  /// This rank's part, to solve with.
  Packing own() const;
  /// The rows that it has read, and what acts on them. Collective.
  Packing rows() const { return rows_.view(); }
  Forces forces_of_rows(const Forces& forces) const;

 private:
  PackingArrays rows_;
  std::unique_ptr<PackingParts> parts_;
};

}  // namespace pfv::app
