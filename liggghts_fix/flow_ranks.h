// SPDX-License-Identifier: GPL-3.0-or-later
// The ranks that hold the flow: rank 0 alone, or all, each with a part of the grains.
#ifndef LMP_PFV_FLOW_RANKS_H
#define LMP_PFV_FLOW_RANKS_H

#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mpi.h>
#include <vector>

namespace pfv {
class Ranks;
}

namespace LAMMPS_NS {

class PfvFlowRanks {
 public:
  explicit PfvFlowRanks(MPI_Comm world);

  /// How the grains were dealt to them.
  struct Dealt {
    bool chosen = false;  ///< which ranks hold the flow
    bool wanted = false;  ///< the grains are dealt anew before the next call
    std::int64_t network = 0;  ///< that was looked at
    int times = 0;             ///< the first one counted
    int column = 0;            ///< of the per-atom array, where the grains' parts stand
    double spread = 0.0;       ///< then, m³
  } dealt;

  /// All ranks hold it from here on; collective.
  void share();
  bool are_all() const { return ranks_ != nullptr; }
  bool is_one() const { return own_ == 0 || are_all(); }  ///< this rank
  bool is_first() const { return own_ == 0; }
  /// For the library; null: rank 0 alone.
  const std::shared_ptr<const pfv::Ranks>& library() const { return ranks_; }

  // over the ranks that hold the flow: collective among these
  void add(double* values, int count) const { reduce(values, count, MPI_SUM); }
  void take_largest(double* values, int count) const { reduce(values, count, MPI_MAX); }
  double sum(double value) const;
  bool any(bool value) const;
  /// Modulo 2^64.
  std::uint64_t sum(std::uint64_t value) const;
  /// What all have, one after the other.
  std::vector<double> everywhere(const std::vector<double>& own) const;
  /// The same on rank 0.
  std::vector<double> gathered(const std::vector<double>& own) const;

 private:
  void reduce(double* values, int count, MPI_Op operation) const;

  MPI_Comm world_;
  int own_ = 0;
  std::shared_ptr<const pfv::Ranks> ranks_;
};

/// Of the grains of all ranks that hold the flow.
struct PfvGrainTotals {
  double count = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();      ///< of the centres, m
  Eigen::Vector3d lowest_centre, highest_centre;       ///< m
  Eigen::Vector3d lower, upper;                        ///< how far the grains reach, m
  double smallest = 0.0, largest = 0.0, mean_radius = 0.0;  ///< m
};
PfvGrainTotals totals_of(const pfv::Packing& packing, const PfvFlowRanks& ranks);

}  // namespace LAMMPS_NS

#endif
