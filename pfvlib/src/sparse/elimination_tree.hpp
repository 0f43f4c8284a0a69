// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace pfv {

/// The supernodes of a symbolic factor: columns first_column[s] ... first_column[s + 1] - 1
/// share the rows rows[rows_begin[s]] ... rows[rows_begin[s + 1] - 1], ascending, the columns themselves
/// first. They are postordered: those of a subtree of the elimination tree follow one another, its root
/// last.
struct Supernodes {
  int width(int s) const { return first_column[s + 1] - first_column[s]; }
  int height(int s) const { return rows_begin[s + 1] - rows_begin[s]; }
  /// Of L, the upper halves of the diagonal blocks left out.
  std::int64_t entries(int s) const {
    const std::int64_t w = width(s);
    return w * (w + 1) / 2 + w * (height(s) - w);
  }

  int count = 0, columns = 0;
  const int* first_column = nullptr;
  const int* rows_begin = nullptr;
  const int* rows = nullptr;
};

/// Subtrees of the elimination tree, which share no column, for threads to take; of about equal work.
/// They depend on the factor alone.
struct SubtreeCut {
  std::vector<std::pair<int, int>> subtrees;  ///< first supernode, root + 1; the largest first
  std::vector<int> above;                     ///< the supernodes in none of them
};

SubtreeCut cut_elimination_tree(const Supernodes& supernodes);

}  // namespace pfv
