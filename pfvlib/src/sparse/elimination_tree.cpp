// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/elimination_tree.hpp"

#include <algorithm>

namespace pfv {
namespace {

/// The supernodes below each one, ascending; those without one above it stand in the last entry.
/// `first`: where the subtree of each begins. The parent of a supernode holds the first of its rows
/// below the diagonal block.
std::vector<std::vector<int>> subtree_children(const Supernodes& supernodes,
                                               std::vector<int>& first) {
  const int count = supernodes.count;
  const int* const columns = supernodes.first_column;
  std::vector<std::vector<int>> children(count + 1);
  first.resize(count);
  for (int s = 0; s < count; ++s) {
    const int below = supernodes.rows_begin[s] + supernodes.width(s);
    const int parent =
        below == supernodes.rows_begin[s + 1]
            ? count
            : static_cast<int>(
                  std::upper_bound(columns, columns + count, supernodes.rows[below]) - columns) - 1;
    first[s] = children[s].empty() ? s : first[children[s].front()];
    children[parent].push_back(s);
  }
  return children;
}

/// Replaces the largest subtree by those below its root until none has more than this part of all
/// the work: two threads are then evenly busy, and what lies above stays small.
constexpr double largest_subtree = 0.26;
/// A factor of fewer entries is one subtree: handing work over would cost more than it saves.
constexpr std::int64_t worth_cutting = 200000;

/// `roots`: of all trees on entry, of the chosen subtrees on return, the largest first.
template <class Work>
void choose_subtrees(std::vector<int>& roots, const std::vector<std::vector<int>>& children,
                     const Work& work, std::int64_t entries) {
  const auto smaller = [&](int a, int b) {
    return work(a) != work(b) ? work(a) < work(b) : a > b;
  };
  if (entries < worth_cutting) return;
  for (;;) {
    const auto largest = std::max_element(roots.begin(), roots.end(), smaller);
    const int root = *largest;
    if (static_cast<double>(work(root)) <= largest_subtree * static_cast<double>(entries) ||
        children[root].empty())
      break;
    roots.erase(largest);
    roots.insert(roots.end(), children[root].begin(), children[root].end());
  }
  std::sort(roots.begin(), roots.end(), [&](int a, int b) { return smaller(b, a); });
}

}  // namespace

SubtreeCut cut_elimination_tree(const Supernodes& supernodes) {
  const int count = supernodes.count;
  std::vector<std::int64_t> entries_before(count + 1, 0);
  for (int s = 0; s < count; ++s)
    entries_before[s + 1] = entries_before[s] + supernodes.entries(s);
  std::vector<int> first;
  const std::vector<std::vector<int>> children = subtree_children(supernodes, first);
  std::vector<int> roots = children[count];
  choose_subtrees(roots, children,
                  [&](int root) { return entries_before[root + 1] - entries_before[first[root]]; },
                  entries_before[count]);
  SubtreeCut cut;
  std::vector<char> is_above(count, 1);
  for (const int root : roots) {
    cut.subtrees.emplace_back(first[root], root + 1);
    std::fill(is_above.begin() + first[root], is_above.begin() + root + 1, 0);
  }
  for (int s = 0; s < count; ++s)
    if (is_above[s]) cut.above.push_back(s);
  return cut;
}

}  // namespace pfv
