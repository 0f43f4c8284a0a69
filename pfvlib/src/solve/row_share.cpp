// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/row_share.hpp"

#include "network/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace pfv {

namespace {

void number_own(const Unknowns& unknowns, const Share& share, RowShare& rows) {
  rows.own.assign(unknowns.count, 0);
  rows.number.assign(unknowns.count, -1);
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore)
    if (unknowns.of_pore[pore] >= 0 && share.own_pores[pore]) rows.own[unknowns.of_pore[pore]] = 1;
  for (const auto& shared : unknowns.shared) rows.own[shared.unknown] = shared.owner == share.ranks->own();
  for (const int border : rows.borders)
    if (border >= 0) rows.own[border] = 0;
  rows.count = std::count(rows.own.begin(), rows.own.end(), 1);
  const std::vector<Ranks::Bytes> counts = [&] {
    Ranks::Bytes bytes;
    append(bytes, &rows.count, 1);
    return share.ranks->gather(bytes);
  }();
  for (int r = 0; r < share.ranks->count(); ++r) {
    rows.begins.push_back(rows.total);
    rows.total += values_in<std::int64_t>(counts[r]).front();
  }
  rows.begins.push_back(rows.total);
  rows.first = rows.begins[share.ranks->own()];
  std::int64_t next = rows.first;
  for (int u = 0; u < unknowns.count; ++u)
    if (rows.own[u]) rows.number[u] = next++;
}

/// Those who have the row of a shared unknown learn who else has it.
void find_sharers(const Unknowns& unknowns, const Share& share, RowShare& rows) {
  const Ranks& ranks = *share.ranks;
  rows.shared = {std::vector<std::vector<int>>(ranks.count()), std::vector<std::vector<int>>(ranks.count())};
  std::vector<Ranks::Bytes> to(ranks.count());
  std::map<std::int64_t, int> own;
  for (const auto& [unknown, owner, name] : unknowns.shared) {
    if (owner == ranks.own()) {
      own.emplace(name, unknown);
      continue;
    }
    append(to[owner], &name, 1);
    rows.shared.received[owner].push_back(unknown);
  }
  const std::vector<Ranks::Bytes> from = ranks.hand_over(to);
  for (int r = 0; r < ranks.count(); ++r)
    for (const std::int64_t name : values_in<std::int64_t>(from[r])) rows.shared.sent[r].push_back(own.at(name));
}

void append_lists(Exchange& exchange, const Exchange& more) {
  for (std::size_t r = 0; r < exchange.sent.size(); ++r) {
    exchange.sent[r].insert(exchange.sent[r].end(), more.sent[r].begin(), more.sent[r].end());
    exchange.received[r].insert(exchange.received[r].end(), more.received[r].begin(), more.received[r].end());
  }
}

/// To the owner of each shared unknown the names of those that own pores join it to.
std::vector<Ranks::Bytes> columns_for_owners(const PoreNetwork& network, const std::vector<double>& conductances,
                                             const Unknowns& unknowns, const Share& share, const RowShare& rows) {
  std::vector<int> owner(unknowns.count, -1);
  for (const auto& shared : unknowns.shared)
    if (!rows.own[shared.unknown]) owner[shared.unknown] = shared.owner;
  std::vector<Ranks::Bytes> to(share.ranks->count());
  for (int t = 0; t < network.throats(); ++t)
    for (int side = 0; side < 2 && conductances[t] > 0.0; ++side) {
      const int pore = network.throat_pores[t][side];
      const int row = unknowns.of_pore[pore], column = unknowns.of_pore[network.throat_pores[t][1 - side]];
      if (row < 0 || column < 0 || row == column || owner[row] < 0 || !share.own_pores[pore]) continue;
      const std::int64_t name = rows.name_of(column);
      append(to[owner[row]], &name, 1);
    }
  return to;
}

/// Finds unknowns by their names.
class NamesHere {
 public:
  explicit NamesHere(const RowShare& rows) : first_(rows.first) {
    for (std::size_t u = 0; u < rows.number.size(); ++u) {
      if (rows.own[u]) own_.push_back(static_cast<int>(u));
      else if (rows.number[u] >= 0) others_.emplace(rows.number[u], static_cast<int>(u));
    }
    for (std::size_t b = 0; b < rows.borders.size(); ++b)
      if (rows.borders[b] >= 0) others_.emplace(rows.total + static_cast<std::int64_t>(b), rows.borders[b]);
  }
  bool knows(std::int64_t name) const { return is_own(name) || others_.count(name) > 0; }
  int at(std::int64_t name) const { return is_own(name) ? own_[name - first_] : others_.at(name); }
  void add(std::int64_t name, int unknown) { others_.emplace(name, unknown); }

 private:
  bool is_own(std::int64_t name) const {
    return name >= first_ && name < first_ + static_cast<std::int64_t>(own_.size());
  }

  std::int64_t first_;
  std::vector<int> own_;
  std::map<std::int64_t, int> others_;
};

/// Adds those that shared rows lead to and this rank does not know; `boundary_of_border`: their numbers.
void add_columns(const PoreNetwork& network, const std::vector<double>& conductances, Unknowns& unknowns,
                 const Share& share, const std::vector<int>& boundary_of_border, RowShare& rows) {
  const Ranks& ranks = *share.ranks;
  const std::vector<Ranks::Bytes> told =
      ranks.hand_over(columns_for_owners(network, conductances, unknowns, share, rows));
  NamesHere known(rows);
  std::vector<Ranks::Bytes> asked(ranks.count());
  Exchange more{std::vector<std::vector<int>>(ranks.count()), std::vector<std::vector<int>>(ranks.count())};
  for (const Ranks::Bytes& bytes : told)
    for (const std::int64_t name : values_in<std::int64_t>(bytes)) {
      if (known.knows(name)) continue;
      const int added = unknowns.count++;
      known.add(name, added);
      rows.own.push_back(0);
      rows.number.push_back(name < rows.total ? name : -1);
      if (name >= rows.total) {
        const auto border = static_cast<std::size_t>(name - rows.total);
        rows.borders[border] = unknowns.of_boundary[boundary_of_border[border]] = added;
        continue;
      }
      append(asked[rows.rank_of(name)], &name, 1);
      more.received[rows.rank_of(name)].push_back(added);
    }
  const std::vector<Ranks::Bytes> from = ranks.hand_over(asked);
  for (int r = 0; r < ranks.count(); ++r)
    for (const std::int64_t name : values_in<std::int64_t>(from[r])) more.sent[r].push_back(known.at(name));
  append_lists(rows.exchange, more);
}

}  // namespace

std::int64_t RowShare::name_of(int unknown) const {
  for (std::size_t b = 0; b < borders.size(); ++b)
    if (borders[b] == unknown) return total + static_cast<std::int64_t>(b);
  return number[unknown];
}

int RowShare::rank_of(std::int64_t wanted) const {
  return static_cast<int>(std::upper_bound(begins.begin(), begins.end(), wanted) - begins.begin()) - 1;
}

void RowShare::collect(Eigen::VectorXd& values) const {
  shared.give_back(*ranks, values, [](double& value, double theirs) { value += theirs; });
  for (const std::vector<int>& of_rank : shared.received)
    for (const int unknown : of_rank) values[unknown] = 0.0;
}

std::shared_ptr<const RowShare> share_rows(const PoreNetwork& network, const std::vector<double>& conductances,
                                           Unknowns& unknowns, const Share& share) {
  auto rows = std::make_shared<RowShare>();
  rows->ranks = share.ranks;
  std::vector<char> is_shared(unknowns.count, 0);
  for (const auto& shared : unknowns.shared) is_shared[shared.unknown] = 1;
  std::vector<int> boundary_of_border;
  const Eigen::VectorXd exists = flux_boundaries_reached(unknowns, share);
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b) {
    if (exists[static_cast<Eigen::Index>(b)] == 0.0) continue;
    rows->borders.push_back(unknowns.of_boundary[b]);
    boundary_of_border.push_back(static_cast<int>(b));
    if (unknowns.of_boundary[b] >= 0) is_shared[unknowns.of_boundary[b]] = 1;
  }
  number_own(unknowns, share, *rows);
  const auto unknowns_of = [&](const std::vector<std::vector<int>>& pores) {
    std::vector<std::vector<int>> lists(pores.size());
    for (std::size_t r = 0; r < pores.size(); ++r)
      for (const int pore : pores[r])
        if (const int u = unknowns.of_pore[pore]; u >= 0 && !is_shared[u]) lists[r].push_back(u);
    return lists;
  };
  rows->exchange = {unknowns_of(share.pores.sent), unknowns_of(share.pores.received)};
  find_sharers(unknowns, share, *rows);
  append_lists(rows->exchange, rows->shared);
  Eigen::VectorXd numbers(unknowns.count);  // exact up to 2^53
  for (int u = 0; u < unknowns.count; ++u) numbers[u] = static_cast<double>(rows->number[u]);
  rows->exchange.refresh(*share.ranks, numbers);
  for (int u = 0; u < unknowns.count; ++u) rows->number[u] = static_cast<std::int64_t>(numbers[u]);
  if (share.any(!unknowns.shared.empty()))
    add_columns(network, conductances, unknowns, share, boundary_of_border, *rows);
  return rows;
}

namespace {

struct SharedEntry {
  std::int64_t row, column;  ///< names
  double value;
};

/// These rows of a matrix with what is added to them.
void add_entries(SymmetricMatrix& matrix, const std::map<int, std::map<int, double>>& added) {
  SymmetricMatrix sum;
  const auto put = [&](int column, double value) {
    sum.column.push_back(column);
    sum.value.push_back(value);
  };
  for (int row = 0; row < matrix.size(); ++row) {
    const auto more = added.find(row);
    const int begin = matrix.row_begin[row], end = matrix.row_begin[row + 1];
    if (more == added.end()) {
      for (int k = begin; k < end; ++k) put(matrix.column[k], matrix.value[k]);
    } else {
      std::map<int, double> entries;
      for (int k = begin; k < end; ++k) entries[matrix.column[k]] = matrix.value[k];
      for (const auto& [column, value] : more->second) entries[column] += value;
      for (const auto& [column, value] : entries) put(column, value);
    }
    sum.row_begin.push_back(static_cast<int>(sum.column.size()));
  }
  matrix = std::move(sum);
}

}  // namespace

void collect_rows(SymmetricMatrix& matrix, const RowShare& rows) {
  const Ranks& ranks = *rows.ranks;
  std::vector<Ranks::Bytes> to(ranks.count());
  for (int r = 0; r < ranks.count(); ++r)
    for (const int row : rows.shared.received[r])
      for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
        const SharedEntry entry{rows.number[row], rows.name_of(matrix.column[k]), matrix.value[k]};
        if (entry.value != 0.0) append(to[r], &entry, 1);
      }
  std::optional<NamesHere> known;
  std::map<int, std::map<int, double>> added;
  for (const Ranks::Bytes& bytes : ranks.hand_over(to))
    for (const SharedEntry& entry : values_in<SharedEntry>(bytes)) {
      if (!known) known.emplace(rows);
      added[known->at(entry.row)][known->at(entry.column)] += entry.value;
    }
  if (!added.empty()) add_entries(matrix, added);
}

void spread_largest(const RowShare& rows, DisjointSets& sets, Eigen::VectorXd& values) {
  const int size = static_cast<int>(values.size());
  Eigen::VectorXd at_borders(static_cast<Eigen::Index>(rows.borders.size()));
  for (bool changed = true; changed;) {
    const Eigen::VectorXd before = values;
    for (int u = 0; u < size; ++u) values[sets.find(u)] = std::max(values[sets.find(u)], values[u]);
    for (int u = 0; u < size; ++u) values[u] = values[sets.find(u)];
    rows.shared.give_back(*rows.ranks, values, [](double& value, double theirs) { value = std::max(value, theirs); });
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

double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& parts,
                         const RowShare& rows) {
  Eigen::VectorXd b = parts;
  rows.collect(b);
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
