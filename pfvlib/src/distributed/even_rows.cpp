// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/even_rows.hpp"

#include "distributed/sphere_records.hpp"

#include <algorithm>
#include <vector>

namespace pfv {

namespace {

/// The first row of each rank and, at the end, how many there are.
std::vector<Eigen::Index> first_rows(Eigen::Index own, const Ranks& ranks) {
  Ranks::Bytes bytes;
  append(bytes, &own, 1);
  std::vector<Eigen::Index> first{0};
  for (const Ranks::Bytes& other : ranks.gather(bytes)) first.push_back(first.back() + values_in<Eigen::Index>(other)[0]);
  return first;
}

}  // namespace

Eigen::Index rows_before(Eigen::Index own, const Ranks& ranks) { return first_rows(own, ranks)[ranks.own()]; }

Eigen::Index rows_of_all(Eigen::Index own, const Ranks& ranks) { return first_rows(own, ranks).back(); }

PackingArrays evenly_divided(PackingArrays rows, const Ranks& ranks) {
  const std::vector<Eigen::Index> first = first_rows(rows.ids.size(), ranks);
  const auto goal = [&](int r) { return first.back() * r / ranks.count(); };
  bool even = true;
  for (int r = 0; r < ranks.count(); ++r) even = even && first[r] == goal(r);
  if (even) return rows;
  std::vector<std::vector<int>> sent(ranks.count());
  const Eigen::Index before = first[ranks.own()];
  for (int r = 0; r < ranks.count(); ++r)
    for (Eigen::Index k = std::max(goal(r), before); k < std::min(goal(r + 1), before + rows.ids.size()); ++k)
      sent[r].push_back(static_cast<int>(k - before));
  std::vector<int> received;
  return handed_over(rows.view(), sent, received, ranks);
}

}  // namespace pfv
