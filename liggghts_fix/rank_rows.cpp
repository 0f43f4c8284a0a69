// SPDX-License-Identifier: GPL-3.0-or-later
#include "rank_rows.h"

#include "comm.h"

#include <mpi.h>
#include <algorithm>
#include <numeric>

namespace LAMMPS_NS {

namespace {

std::vector<int> times(const std::vector<int>& counts, int width) {
  std::vector<int> scaled(counts);
  for (int& count : scaled) count *= width;
  return scaled;
}

}  // namespace

void PfvRankRows::Ends::sum_up() {
  offsets.resize(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  total = offsets.back() + counts.back();
}

void PfvRankRows::set_homes(std::vector<int> homes) {
  leaving_.counts.assign(comm->nprocs, 0);
  for (const int home : homes) ++leaving_.counts[home];
  leaving_.sum_up();
  arriving_.counts.resize(comm->nprocs);
  MPI_Alltoall(leaving_.counts.data(), 1, MPI_INT, arriving_.counts.data(), 1, MPI_INT, world);
  arriving_.sum_up();
  place_.clear();
  if (std::is_sorted(homes.begin(), homes.end())) return;
  std::vector<int> next = leaving_.offsets;
  place_ = std::move(homes);
  for (int& place : place_) place = next[place]++;
}

std::vector<double> PfvRankRows::exchanged(const std::vector<double>& rows, const Ends& from, const Ends& to,
                                           int width) const {
  std::vector<double> result(std::size_t(width) * to.total);
  MPI_Alltoallv(rows.data(), times(from.counts, width).data(), times(from.offsets, width).data(), MPI_DOUBLE,
                result.data(), times(to.counts, width).data(), times(to.offsets, width).data(), MPI_DOUBLE, world);
  return result;
}

std::vector<double> PfvRankRows::to_homes(const std::vector<double>& mine, int width) const {
  if (place_.empty()) return exchanged(mine, leaving_, arriving_, width);
  std::vector<double> rows(mine.size());
  for (std::size_t k = 0; k < place_.size(); ++k)
    std::copy_n(&mine[width * k], width, &rows[std::size_t(width) * place_[k]]);
  return exchanged(rows, leaving_, arriving_, width);
}

std::vector<double> PfvRankRows::back(const std::vector<double>& here, int width) const {
  std::vector<double> rows = exchanged(here, arriving_, leaving_, width);
  if (place_.empty()) return rows;
  std::vector<double> mine(rows.size());
  for (std::size_t k = 0; k < place_.size(); ++k)
    std::copy_n(&rows[std::size_t(width) * place_[k]], width, &mine[width * k]);
  return mine;
}

}  // namespace LAMMPS_NS
