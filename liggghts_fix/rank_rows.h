// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of numbers from where LIGGGHTS has the atoms to the ranks that have them in the flow, and back.
#ifndef LMP_PFV_RANK_ROWS_H
#define LMP_PFV_RANK_ROWS_H

#include "pointers.h"

#include <cstddef>
#include <vector>

namespace LAMMPS_NS {

class PfvRankRows : protected Pointers {
 public:
  explicit PfvRankRows(class LAMMPS* lmp) : Pointers(lmp) {}

  /// The rank that each of this rank's rows goes to; collective.
  void set_homes(std::vector<int> homes);
  /// Rows that arrive here.
  int count() const { return arriving_.total; }

  /// `mine`: `width` numbers for each row of this rank. Those of the rows that arrive here, in the order of the ranks
  /// that they come from; collective.
  std::vector<double> to_homes(const std::vector<double>& mine, int width) const;
  /// The other way round: `here` has `width` numbers for each row that has arrived; collective.
  std::vector<double> back(const std::vector<double>& here, int width) const;

 private:
  struct Ends {
    std::vector<int> counts, offsets;  ///< rows of each rank
    int total = 0;
    void sum_up();
  };
  std::vector<double> exchanged(const std::vector<double>& rows, const Ends& from, const Ends& to, int width) const;

  /// Of each own row among those that leave, which stand in the order of their homes; empty where they stand so here.
  std::vector<int> place_;
  Ends leaving_, arriving_;
};

}  // namespace LAMMPS_NS

#endif
