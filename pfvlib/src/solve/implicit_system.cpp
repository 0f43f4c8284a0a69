// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/implicit_system.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace pfv {

namespace {

/// S^T B^1/2 by unknowns: the rows of S that yield, with the pores of one unknown added up, and the
/// same entries once more by unknown.
struct YieldingRows {
  struct Entry {
    int index;  ///< unknown, or row
    Vector6d value;
  };
  std::vector<std::vector<Entry>> of_row;
  std::vector<std::vector<Entry>> of_unknown;
};

/// Adds the entries of one row that yields, those of one unknown summed up.
void add_row(YieldingRows& rows, std::vector<YieldingRows::Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.index < b.index; });
  auto& merged = rows.of_row.emplace_back();
  for (const auto& entry : entries) {
    if (!merged.empty() && merged.back().index == entry.index)
      merged.back().value += entry.value;
    else
      merged.push_back(entry);
  }
  const int number = static_cast<int>(rows.of_row.size()) - 1;
  for (const auto& entry : merged) rows.of_unknown[entry.index].push_back({number, entry.value});
}

YieldingRows yielding_rows(const Unknowns& unknowns, const ForceMatrix& forces, const Bases& bases,
                           const Matrix6Xd& yielding) {
  const int spheres = forces.spheres;
  YieldingRows rows;
  rows.of_unknown.resize(unknowns.count);
  std::vector<YieldingRows::Entry> entries;
  for (int row = 0; row < forces.rows(); ++row) {
    if (!(yielding.col(row).array() > 0.0).any()) continue;
    const Vector6d root = yielding.col(row).cwiseSqrt();
    entries.clear();
    const auto add = [&](int pore, const Vector6d& load) {
      if (unknowns.of_pore[pore] != Unknowns::imposed)
        entries.push_back({unknowns.of_pore[pore], root.cwiseProduct(load)});
    };
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      add(forces.pore[e], forces.value.col(e));
    for (int b = 0; row >= spheres && b < bases.size(); ++b)
      if (bases.face[b] == row - spheres) add(bases.pore[b], bases.load(b));
    add_row(rows, entries);
  }
  return rows;
}

/// Whether a uniform pressure in the set would move something: it does not where the set surrounds what
/// yields on all sides.
bool yields_to(const Isolated& isolated, const Unknowns& unknowns, const YieldingRows& rows) {
  std::vector<int> members;
  for (const int pore : isolated.pores) members.push_back(unknowns.of_pore[pore]);
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::map<int, std::pair<Vector6d, double>> sums;  // by row: the sum and its largest part
  for (const int unknown : members)
    for (const auto& entry : rows.of_unknown[unknown]) {
      auto& [sum, largest] =
          sums.try_emplace(entry.index, Vector6d::Zero(), 0.0).first->second;
      sum += entry.value;
      largest = std::max(largest, entry.value.norm());
    }
  return std::any_of(sums.begin(), sums.end(), [](const auto& row) {
    constexpr double round_off = 1e-10;
    return row.second.first.norm() > round_off * row.second.second;
  });
}

/// G + S^T B S without the pins, row by row.
SymmetricMatrix sum_of(const SymmetricMatrix& g, const std::vector<double>& pins,
                       const YieldingRows& rows) {
  constexpr std::size_t denser = 14;  // entries than G, about
  const int count = g.size();
  SymmetricMatrix a;
  a.row_begin.reserve(g.row_begin.size());
  a.column.reserve(denser * g.column.size());
  a.value.reserve(denser * g.column.size());
  std::vector<double> sum(count, 0.0);
  std::vector<int> touched, last_row(count, -1);
  for (int i = 0; i < count; ++i) {
    touched.clear();
    const auto add = [&](int j, double value) {
      if (last_row[j] != i) {
        last_row[j] = i;
        sum[j] = 0.0;
        touched.push_back(j);
      }
      sum[j] += value;
    };
    for (int k = g.row_begin[i]; k < g.row_begin[i + 1]; ++k) add(g.column[k], g.value[k]);
    add(i, -pins[i]);
    for (const auto& mine : rows.of_unknown[i])
      for (const auto& other : rows.of_row[mine.index])
        add(other.index, mine.value.dot(other.value));
    std::sort(touched.begin(), touched.end());
    for (const int j : touched) {
      a.column.push_back(j);
      a.value.push_back(sum[j]);
    }
    a.row_begin.push_back(static_cast<int>(a.column.size()));
  }
  return a;
}

}  // namespace

ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns,
                                 const ForceMatrix& forces, const Bases& bases,
                                 const Matrix6Xd& yielding) {
  const YieldingRows rows = yielding_rows(unknowns, forces, bases, yielding);
  ImplicitSystem result;
  std::vector<double> pins(unknowns.count, 0.0);
  for (const Isolated& isolated : system.isolated) {
    if (yields_to(isolated, unknowns, rows))
      pins[isolated.unknown] = isolated.pin;
    else
      result.isolated.push_back(isolated);
  }
  result.matrix = sum_of(system.matrix, pins, rows);
  return result;
}

}  // namespace pfv
