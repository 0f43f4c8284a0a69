// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/row_share.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pfv {

namespace {

void number_own(const Unknowns& unknowns, const Share& share, RowShare& rows) {
  rows.own.assign(unknowns.count, 0);
  rows.number.assign(unknowns.count, -1);
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore)
    if (unknowns.of_pore[pore] >= 0 && share.own_pores[pore]) rows.own[unknowns.of_pore[pore]] = 1;
  for (const int border : rows.borders)
    if (border >= 0) rows.own[border] = 0;
  rows.count = std::count(rows.own.begin(), rows.own.end(), 1);
  const std::vector<Ranks::Bytes> counts = [&] {
    Ranks::Bytes bytes;
    append(bytes, &rows.count, 1);
    return share.ranks->gather(bytes);
  }();
  for (int r = 0; r < share.ranks->count(); ++r) {
    const std::int64_t count = values_in<std::int64_t>(counts[r]).front();
    if (r < share.ranks->own()) rows.first += count;
    rows.total += count;
  }
  std::int64_t next = rows.first;
  for (int u = 0; u < unknowns.count; ++u)
    if (rows.own[u]) rows.number[u] = next++;
}

}  // namespace

std::shared_ptr<const RowShare> share_rows(const Unknowns& unknowns, const Share& share) {
  auto rows = std::make_shared<RowShare>();
  rows->ranks = share.ranks;
  std::vector<char> is_border(unknowns.count, 0);
  Eigen::VectorXd exists = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.of_boundary.size()));
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b)
    exists[static_cast<Eigen::Index>(b)] = unknowns.of_boundary[b] >= 0;
  share.ranks->take_largest(exists.data(), static_cast<std::size_t>(exists.size()));
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b) {
    if (exists[static_cast<Eigen::Index>(b)] == 0.0) continue;
    rows->borders.push_back(unknowns.of_boundary[b]);
    if (unknowns.of_boundary[b] >= 0) is_border[unknowns.of_boundary[b]] = 1;
  }
  number_own(unknowns, share, *rows);
  const auto unknowns_of = [&](const std::vector<std::vector<int>>& pores) {
    std::vector<std::vector<int>> lists(pores.size());
    for (std::size_t r = 0; r < pores.size(); ++r)
      for (const int pore : pores[r])
        if (const int u = unknowns.of_pore[pore]; u >= 0 && !is_border[u]) lists[r].push_back(u);
    return lists;
  };
  rows->exchange = {unknowns_of(share.pores.sent), unknowns_of(share.pores.received)};
  Eigen::VectorXd numbers(unknowns.count);  // exact up to 2^53
  for (int u = 0; u < unknowns.count; ++u) numbers[u] = static_cast<double>(rows->number[u]);
  rows->exchange.refresh(*share.ranks, numbers);
  for (int u = 0; u < unknowns.count; ++u) rows->number[u] = static_cast<std::int64_t>(numbers[u]);
  return rows;
}

void spread_largest(const RowShare& rows, DisjointSets& sets, Eigen::VectorXd& values) {
  const int size = static_cast<int>(values.size());
  Eigen::VectorXd at_borders(static_cast<Eigen::Index>(rows.borders.size()));
  for (bool changed = true; changed;) {
    const Eigen::VectorXd before = values;
    for (int u = 0; u < size; ++u) values[sets.find(u)] = std::max(values[sets.find(u)], values[u]);
    for (int u = 0; u < size; ++u) values[u] = values[sets.find(u)];
    rows.exchange.refresh(*rows.ranks, values);
    for (std::size_t b = 0; b < rows.borders.size(); ++b)
      at_borders[static_cast<Eigen::Index>(b)] =
          rows.borders[b] >= 0 ? values[rows.borders[b]] : -std::numeric_limits<double>::infinity();
    rows.ranks->take_largest(at_borders.data(), rows.borders.size());
    for (std::size_t b = 0; b < rows.borders.size(); ++b)
      if (rows.borders[b] >= 0) values[rows.borders[b]] = at_borders[static_cast<Eigen::Index>(b)];
    changed = rows.ranks->any(before != values);
  }
}

namespace {

/// 1 where open throats lead to an imposed pressure, on whatever rank; joins what they join here.
Eigen::VectorXd anchored_unknowns(const PoreNetwork& network, const std::vector<double>& conductances,
                                  const Unknowns& unknowns, const Share& share, const RowShare& rows, DisjointSets& sets) {
  Eigen::VectorXd anchored = Eigen::VectorXd::Zero(unknowns.count);
  for (int t = 0; t < network.throats(); ++t) {
    const auto [p, q] = network.throat_pores[t];
    if (conductances[t] <= 0.0 || !(share.own_pores[p] || share.own_pores[q])) continue;
    const int i = unknowns.of_pore[p], j = unknowns.of_pore[q];
    if (i >= 0 && j >= 0) sets.join(i, j);
    if ((i < 0) != (j < 0)) anchored[std::max(i, j)] = 1.0;
  }
  spread_largest(rows, sets, anchored);
  return anchored;
}

std::vector<double> sorted_once(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<double> labels_of_all(std::vector<double> here, const Ranks& ranks) {
  here = sorted_once(std::move(here));
  Ranks::Bytes bytes;
  append(bytes, here.data(), here.size());
  std::vector<double> labels;
  for (const Ranks::Bytes& part : ranks.gather(bytes))
    for (const double value : values_in<double>(part)) labels.push_back(value);
  return sorted_once(std::move(labels));
}

/// Sets of nothing but a border are held by it, on the lowest rank that has it.
void hold_borders(const RowShare& rows, const std::vector<double>& labels, const std::vector<double>& of_border,
                  std::vector<Isolated>& isolated) {
  const double own = -rows.ranks->own();
  for (std::size_t b = 0; b < of_border.size(); ++b) {
    const bool lowest = rows.ranks->largest(rows.borders[b] >= 0 ? own : -rows.ranks->count()) == own;
    const auto found = std::lower_bound(labels.begin(), labels.end(), of_border[b]);
    if (lowest && found != labels.end() && *found == of_border[b])
      isolated[static_cast<std::size_t>(found - labels.begin())].unknown = rows.borders[b];
  }
}

}  // namespace

std::vector<Isolated> find_isolated(const PoreNetwork& network, const std::vector<double>& conductances,
                                    const Unknowns& unknowns, const Share& share, const RowShare& rows) {
  DisjointSets sets(unknowns.count);
  const Eigen::VectorXd anchored = anchored_unknowns(network, conductances, unknowns, share, rows, sets);
  // a set is known by the least number in it; borders come after all rows
  constexpr double none = -std::numeric_limits<double>::infinity();
  Eigen::VectorXd label = Eigen::VectorXd::Constant(unknowns.count, none);
  for (int u = 0; u < unknowns.count; ++u)
    if (rows.own[u]) label[u] = -static_cast<double>(rows.number[u]);
  std::vector<double> label_of_border;
  for (std::size_t b = 0; b < rows.borders.size(); ++b) {
    label_of_border.push_back(-static_cast<double>(rows.total) - static_cast<double>(b));
    if (rows.borders[b] >= 0) label[rows.borders[b]] = label_of_border[b];
  }
  spread_largest(rows, sets, label);
  const auto is_isolated = [&](std::size_t pore) {
    const int u = unknowns.of_pore[pore];
    return u >= 0 && share.own_pores[pore] && anchored[u] == 0.0;
  };
  std::vector<double> here;
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore)
    if (is_isolated(pore)) here.push_back(label[unknowns.of_pore[pore]]);
  const std::vector<double> labels = labels_of_all(std::move(here), *rows.ranks);
  std::vector<Isolated> isolated(labels.size(), Isolated{{}, -1, 0.0});
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore) {
    if (!is_isolated(pore)) continue;
    const int u = unknowns.of_pore[pore];
    Isolated& set = isolated[std::lower_bound(labels.begin(), labels.end(), label[u]) - labels.begin()];
    set.pores.push_back(static_cast<int>(pore));
    if (rows.own[u] && static_cast<double>(rows.number[u]) == -label[u]) set.unknown = u;
  }
  hold_borders(rows, labels, label_of_border, isolated);
  return isolated;
}

double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& b,
                         const RowShare& rows) {
  const Eigen::VectorXd r = b - multiply(matrix, x);
  Eigen::VectorXd at_borders = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(rows.borders.size()));  // parts
  for (std::size_t i = 0; i < rows.borders.size(); ++i)
    if (rows.borders[i] >= 0) at_borders.segment<2>(2 * static_cast<Eigen::Index>(i)) << r[rows.borders[i]], b[rows.borders[i]];
  rows.ranks->add(at_borders.data(), static_cast<std::size_t>(at_borders.size()));
  double squares[2] = {0.0, 0.0};
  for (int u = 0; u < matrix.size(); ++u) {
    if (!rows.own[u]) continue;
    squares[0] += r[u] * r[u];
    squares[1] += b[u] * b[u];
  }
  rows.ranks->add(squares, 2);
  for (Eigen::Index i = 0; i < at_borders.size(); ++i) squares[i % 2] += at_borders[i] * at_borders[i];
  return squares[1] > 0.0 ? std::sqrt(squares[0] / squares[1]) : 0.0;
}

}  // namespace pfv
