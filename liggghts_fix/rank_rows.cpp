// SPDX-License-Identifier: GPL-3.0-or-later
#include "rank_rows.h"

#include "comm.h"

#include <mpi.h>
#include <numeric>

namespace LAMMPS_NS {

namespace {

std::vector<int> times(const std::vector<int>& counts, int width) {
  std::vector<int> scaled(counts);
  for (int& count : scaled) count *= width;
  return scaled;
}

}  // namespace

std::vector<double>& PfvRankRows::begin(int width) {
  width_ = width;
  local_.clear();
  return local_;
}

void PfvRankRows::gather() {
  local_count_ = static_cast<int>(local_.size()) / width_;
  counts_.resize(comm->nprocs);
  offsets_.resize(comm->nprocs);
  MPI_Gather(&local_count_, 1, MPI_INT, counts_.data(), 1, MPI_INT, 0, world);
  if (comm->me == 0) {
    std::exclusive_scan(counts_.begin(), counts_.end(), offsets_.begin(), 0);
    received_.resize(std::size_t(width_) * (offsets_.back() + counts_.back()));
  }
  MPI_Gatherv(local_.data(), width_ * local_count_, MPI_DOUBLE, received_.data(), times(counts_, width_).data(),
              times(offsets_, width_).data(), MPI_DOUBLE, 0, world);
}

std::vector<double> PfvRankRows::scatter(const std::vector<double>& all, int width) {
  std::vector<double> mine(std::size_t(width) * local_count_);
  MPI_Scatterv(all.data(), times(counts_, width).data(), times(offsets_, width).data(), MPI_DOUBLE, mine.data(),
               width * local_count_, MPI_DOUBLE, 0, world);
  return mine;
}

double PfvRankRows::memory_usage() const {
  return sizeof(double) * static_cast<double>(local_.capacity() + received_.capacity());
}

}  // namespace LAMMPS_NS
