// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

namespace pfv {

class Ranks;

/// Entries of one half of a symmetric matrix: (i, j) or (j, i), not both. Those of one place are added, whichever ranks
/// tell of them.
struct HalfEntries {
  std::vector<int> row, column;  ///< from 0 on
  std::vector<double> value;
};

/// The Cholesky factor of a symmetric positive definite matrix by MUMPS (Amestoy et al. 2001, 2006), on the calling rank alone
/// or on several that each tell of a part of it and hold a part of the factor. Every method is called by all of them. The sums
/// of several ranks are made in the order in which messages come: runs differ by round-off. Starts MPI where the program has
/// not. Throws SparseError and std::bad_alloc, on all ranks alike.
class MumpsFactor {
 public:
  /// `ranks`: null on one rank; else they outlive this.
  explicit MumpsFactor(const Ranks* ranks);
  ~MumpsFactor();
  MumpsFactor(const MumpsFactor&) = delete;
  MumpsFactor& operator=(const MumpsFactor&) = delete;

  /// Orders `size` rows; values do not count.
  void analyse(int size, const HalfEntries& entries);
  /// The entries of `analyse` with the values that they have now.
  void factor(const HalfEntries& entries);
  /// On the first rank all of b, which becomes x; elsewhere nothing is read.
  void solve(std::vector<double>& b);

 private:
  struct Instance;
  std::unique_ptr<Instance> instance_;
};

}  // namespace pfv
