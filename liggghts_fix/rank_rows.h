// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of numbers of all ranks on rank 0, and rows back to where they came from.
#ifndef LMP_PFV_RANK_ROWS_H
#define LMP_PFV_RANK_ROWS_H

#include "pointers.h"

#include <cstddef>
#include <vector>

namespace LAMMPS_NS {

class PfvRankRows : protected Pointers {
 public:
  explicit PfvRankRows(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Empty, for this rank's rows of `width` numbers each, one after the other.
  std::vector<double>& begin(int width);
  int width() const { return width_; }
  /// The rows of all ranks on rank 0, in the order of the ranks; collective.
  void gather();
  int count() const { return static_cast<int>(received_.size()) / width_; }  ///< rank 0
  const double* row(int k) const { return &received_[std::size_t(width_) * k]; }

  /// This rank's part of `all` (rank 0), which has a row of `width` numbers for each that was gathered; collective.
  std::vector<double> scatter(const std::vector<double>& all, int width);

  double memory_usage() const;

 private:
  int width_ = 1;                      // numbers a row
  int local_count_ = 0;                // rows
  std::vector<double> local_, received_;
  std::vector<int> counts_, offsets_;  // rows of each rank
};

}  // namespace LAMMPS_NS

#endif
