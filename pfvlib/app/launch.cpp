// SPDX-License-Identifier: GPL-3.0-or-later
#include "launch.hpp"

#include "distributed/packing_parts.hpp"
#include "parallel/mpi_session.hpp"
#include "pfv/error.hpp"
#include "pfv/mpi.hpp"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace pfv::app {
namespace {

std::shared_ptr<const Ranks> start() {
  const char* wish = std::getenv("PFV_RANKS");
  if (!MpiSession::is_launched() || (wish && std::string(wish) == "one")) return nullptr;
  MpiSession::start();
  return ranks_of(MPI_COMM_WORLD);
}

}  // namespace

std::shared_ptr<const Ranks> launched_ranks() {
  static const std::shared_ptr<const Ranks> ranks = start();
  return ranks;
}

void refuse_unlike_arguments(const Ranks& ranks, const std::string& arguments) {
  bool unlike = false;
  for (const Ranks::Bytes& other : ranks.gather({arguments.begin(), arguments.end()}))
    unlike = unlike || std::string(other.begin(), other.end()) != arguments;
  const bool any_unlike = ranks.any(unlike);
  ranks.together([&] {
    if (any_unlike)
      throw InputError("the ranks have been given different arguments: under one mpirun they share one packing; for programs "
                       "that each do something of their own set PFV_RANKS=one in their environment");
  });
}

bool speaks(const Ranks* ranks) { return !ranks || ranks->own() == 0; }

void end_others(const Ranks* ranks, int status) {
  if (ranks && !ranks->failed_together()) MPI_Abort(MPI_COMM_WORLD, status);
}

DealtPacking::DealtPacking(PackingArrays rows, const Container& container, const Ranks* ranks) : rows_(std::move(rows)) {
  if (ranks) parts_ = std::make_unique<PackingParts>(rows_.view(), container, *ranks);
}

DealtPacking::~DealtPacking() = default;

Packing DealtPacking::own() const { return parts_ ? parts_->own().view() : rows_.view(); }

Forces DealtPacking::forces_of_rows(const Forces& forces) const {
  if (!parts_) return forces;
  Forces rows;
  rows.total = parts_->returned(forces.total);
  rows.pressure = parts_->returned(forces.pressure);
  rows.viscous = parts_->returned(forces.viscous);
  rows.torque = parts_->returned(forces.torque);
  return rows;
}

}  // namespace pfv::app
