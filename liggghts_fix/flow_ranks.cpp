// SPDX-License-Identifier: GPL-3.0-or-later
#include "flow_ranks.h"

#include "pfv/mpi.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace LAMMPS_NS {

PfvFlowRanks::PfvFlowRanks(MPI_Comm world) : world_(world) { MPI_Comm_rank(world_, &own_); }

void PfvFlowRanks::share() {
  if (!ranks_) ranks_ = pfv::ranks_of(world_);
}

void PfvFlowRanks::reduce(double* values, int count, MPI_Op operation) const {
  if (are_all()) MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, operation, world_);
}

std::uint64_t PfvFlowRanks::sum(std::uint64_t value) const {
  if (are_all()) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, world_);
  return value;
}

double PfvFlowRanks::sum(double value) const {
  add(&value, 1);
  return value;
}

bool PfvFlowRanks::any(bool value) const {
  double largest = value;
  take_largest(&largest, 1);
  return largest > 0.0;
}

std::vector<double> PfvFlowRanks::gathered(const std::vector<double>& own) const {
  if (!are_all()) return own;
  int ranks = 0, count = static_cast<int>(own.size());
  MPI_Comm_size(world_, &ranks);
  std::vector<int> counts(ranks), offsets(ranks);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, world_);
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  std::vector<double> all(is_first() ? offsets.back() + counts.back() : 0);
  MPI_Gatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, 0, world_);
  return all;
}

std::vector<double> PfvFlowRanks::everywhere(const std::vector<double>& own) const {
  if (!are_all()) return own;
  int ranks = 0, count = static_cast<int>(own.size());
  MPI_Comm_size(world_, &ranks);
  std::vector<int> counts(ranks), offsets(ranks);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world_);
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  std::vector<double> all(offsets.back() + counts.back());
  MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, world_);
  return all;
}

PfvGrainTotals totals_of(const pfv::Packing& packing, const PfvFlowRanks& ranks) {
  PfvGrainTotals totals;
  const auto& centres = packing.positions;
  const auto& radii = packing.radii;
  Eigen::Matrix<double, 5, 1> sums = Eigen::Matrix<double, 5, 1>::Zero();
  Eigen::Matrix<double, 14, 1> largest;
  largest.setConstant(-std::numeric_limits<double>::infinity());
  if (packing.size() > 0) {
    const Eigen::Matrix3Xd reach = radii.transpose().replicate<3, 1>();
    sums << static_cast<double>(packing.size()), centres.rowwise().sum(), radii.sum();
    largest << centres.rowwise().maxCoeff(), -centres.rowwise().minCoeff(), (centres + reach).rowwise().maxCoeff(),
        -(centres - reach).rowwise().minCoeff(), radii.maxCoeff(), -radii.minCoeff();
  }
  ranks.add(sums.data(), 5);
  ranks.take_largest(largest.data(), 14);
  totals.count = sums[0];
  if (sums[0] > 0.0) {
    totals.mean = sums.segment<3>(1) / sums[0];
    totals.mean_radius = sums[4] / sums[0];
  }
  totals.highest_centre = largest.segment<3>(0);
  totals.lowest_centre = -largest.segment<3>(3);
  totals.upper = largest.segment<3>(6);
  totals.lower = -largest.segment<3>(9);
  totals.largest = largest[12];
  totals.smallest = -largest[13];
  return totals;
}

}  // namespace LAMMPS_NS
