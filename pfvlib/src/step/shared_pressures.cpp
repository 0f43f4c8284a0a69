// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/shared_pressures.hpp"

#include "network/canonical_order.hpp"
#include "network/pore_network.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>

namespace pfv {

namespace {

/// A cell of the old network, told; one of the new one, asked for, without a pressure.
struct NamedCell {
  CellName name;
  std::array<double, 3> place;  ///< `centre_of_cell`
  double pressure = 0.0;

  Eigen::Map<const Eigen::Vector3d> centre() const { return Eigen::Map<const Eigen::Vector3d>(place.data()); }
};

bool has_smaller_name(const NamedCell& a, const NamedCell& b) { return a.name < b.name; }

NamedCell named_cell(const BuiltNetwork& built, int cell) {
  const Eigen::Vector3d place = centre_of_cell(built, cell);
  return {cell_name(built.network.cell_vertices[cell], built.vertices), {place[0], place[1], place[2]}};
}

/// The rank that is told of a cell of this name.
int teller(const CellName& name, int ranks) {
  std::uint64_t mixed = 0;
  for (const std::int64_t id : name) mixed = (mixed ^ static_cast<std::uint64_t>(id)) * 0x9e3779b97f4a7c15u;
  return static_cast<int>((mixed >> 32) % static_cast<std::uint64_t>(ranks));
}

/// What an asked rank knows; found: 1 or 0, or how far a place lies outside a cell, m.
struct Answer {
  double found, pressure;
};

/// Cells of own pores of the old network, told to those who will be asked for them, ascending by their names.
std::vector<NamedCell> told_cells(const FormerPressures& old, const Ranks& ranks) {
  std::vector<Ranks::Bytes> to(ranks.count());
  for (int c = 0; old.network && c < old.network->network.cells(); ++c) {
    const int pore = old.network->network.cell_pore[c];
    if (!old.network->share.own_pores[pore]) continue;
    NamedCell cell = named_cell(*old.network, c);
    cell.pressure = old.values[pore];
    append(to[teller(cell.name, ranks.count())], &cell, 1);
  }
  std::vector<NamedCell> told;
  for (const Ranks::Bytes& bytes : ranks.hand_over(to))
    for (const NamedCell& cell : values_in<NamedCell>(bytes)) told.push_back(cell);
  std::stable_sort(told.begin(), told.end(), has_smaller_name);
  return told;
}

/// Asks and answers: `to` as handed over; each rank's answers, one a question.
template <class Question, class Reply>
std::vector<std::vector<Answer>> answers_of(const std::vector<Ranks::Bytes>& to, const Ranks& ranks,
                                            const Reply& reply) {
  std::vector<Ranks::Bytes> replies(ranks.count());
  const std::vector<Ranks::Bytes> from = ranks.hand_over(to);
  for (int r = 0; r < ranks.count(); ++r)
    for (const Question& question : values_in<Question>(from[r])) {
      const Answer answer = reply(question);
      append(replies[r], &answer, 1);
    }
  std::vector<std::vector<Answer>> answers;
  for (const Ranks::Bytes& bytes : ranks.hand_over(replies)) answers.push_back(values_in<Answer>(bytes));
  return answers;
}

Answer pressure_of(const NamedCell& asked, const std::vector<NamedCell>& told, const BuiltNetwork& now) {
  SurvivingCell survivor(asked.centre(), now);
  const auto [first, last] = std::equal_range(told.begin(), told.end(), asked, has_smaller_name);
  for (auto cell = first; cell != last; ++cell) survivor.meet(cell->centre(), cell->pressure);
  return {survivor.pressure() ? 1.0 : 0.0, survivor.pressure().value_or(0.0)};
}

/// Of each own pore of `now` the sum of the pressures of its cells that were there before, and how many there are.
void sum_of_survivors(const FormerPressures& old, const BuiltNetwork& now, Eigen::VectorXd& sum, Eigen::VectorXi& count) {
  const Ranks& ranks = *now.share.ranks;
  const std::vector<NamedCell> told = told_cells(old, ranks);
  std::vector<Ranks::Bytes> to(ranks.count());
  std::vector<int> asked(now.network.cells(), -1);
  for (int c = 0; c < now.network.cells(); ++c) {
    if (!now.share.own_pores[now.network.cell_pore[c]]) continue;
    const NamedCell cell = named_cell(now, c);
    asked[c] = teller(cell.name, ranks.count());
    append(to[asked[c]], &cell, 1);
  }
  const auto answers =
      answers_of<NamedCell>(to, ranks, [&](const NamedCell& cell) { return pressure_of(cell, told, now); });
  std::vector<std::size_t> next(ranks.count(), 0);
  for (int c = 0; c < now.network.cells(); ++c) {
    if (asked[c] < 0) continue;
    const Answer& answer = answers[asked[c]][next[asked[c]]++];
    if (answer.found == 0.0) continue;
    sum[now.network.cell_pore[c]] += answer.pressure;
    ++count[now.network.cell_pore[c]];
  }
}

/// Own pores of which nothing was there before take what is found at their places, here or elsewhere.
void fill_from_places(const FormerPressures& old, const BuiltNetwork& now, const Eigen::VectorXi& count,
                      Eigen::VectorXd& values) {
  const Ranks& ranks = *now.share.ranks;
  FormerPlaces places(old, now.container.pressure_gradient);
  std::vector<int> elsewhere;
  Ranks::Bytes questions;
  for (int p = 0; p < now.network.pores(); ++p) {
    if (!now.share.own_pores[p] || count[p] > 0) continue;
    const Eigen::Vector3d place = now.network.origin + now.network.pore_centres.col(p);
    const FormerPlaces::Found own = places.at(place);
    values[p] = own.pressure;
    if (own.outside == 0.0) continue;
    elsewhere.push_back(p);
    append(questions, place.data(), 3);
  }
  const auto answers = answers_of<std::array<double, 3>>(
      std::vector<Ranks::Bytes>(ranks.count(), questions), ranks, [&](const std::array<double, 3>& place) -> Answer {
        const FormerPlaces::Found found = places.at(Eigen::Map<const Eigen::Vector3d>(place.data()));
        return {found.outside, found.pressure};
      });
  for (std::size_t i = 0; i < elsewhere.size(); ++i) {
    Answer best{std::numeric_limits<double>::infinity(), 0.0};
    for (const std::vector<Answer>& of_rank : answers)
      if (of_rank[i].found < best.found) best = of_rank[i];
    values[elsewhere[i]] = best.pressure;
  }
}

/// A vertex in the order of the curve, images of one sphere by their places.
struct VertexRank {
  std::uint64_t number;
  std::int64_t id;
  std::array<double, 3> place;
  bool operator<(const VertexRank& other) const {
    return std::tie(number, id, place) < std::tie(other.number, other.id, other.place);
  }
};

/// A pore's place among all: the vertices of its first cell along the curve, walls last.
using PoreRank = std::array<VertexRank, 4>;

std::vector<PoreRank> own_pores_in_order(const BuiltNetwork& built) {
  const std::vector<std::uint64_t> numbers = curve_numbers(built.vertices);
  std::vector<PoreRank> ranked;
  int next = 0;
  for (int c = 0; c < built.network.cells(); ++c) {
    const int pore = built.network.cell_pore[c];
    if (pore != next) continue;
    ++next;
    if (!built.share.own_pores[pore]) continue;
    PoreRank rank;
    for (int i = 0; i < 4; ++i) {
      const Vertex v = built.network.cell_vertices[c][i];
      if (is_wall(v)) {
        rank[i] = {std::numeric_limits<std::uint64_t>::max(), wall_number(v), {}};
        continue;
      }
      const auto place = built.vertices.centres.col(v);
      rank[i] = {numbers[v], built.vertices.ids[v], {place[0], place[1], place[2]}};
    }
    std::sort(rank.begin(), rank.end());
    ranked.push_back(rank);
  }
  return ranked;
}

}  // namespace

Eigen::VectorXd carried_on_ranks(const FormerPressures& old, const BuiltNetwork& now) {
  const Share& share = now.share;
  const int pores = now.network.pores();
  Eigen::VectorXd values = Eigen::VectorXd::Zero(pores);
  Eigen::VectorXi count = Eigen::VectorXi::Zero(pores);
  sum_of_survivors(old, now, values, count);
  for (int p = 0; p < pores; ++p)
    if (count[p] > 0) values[p] /= count[p];
  fill_from_places(old, now, count, values);
  // the sum of V^f p is what the storage term conserves (thesis eq. 4.8 with compressibility)
  const Eigen::VectorXd after = storage_volumes(now.throats);
  Eigen::VectorXd sums(3);
  sums << (old.network ? storage_volumes(old.network->throats).dot(old.values) : 0.0), after.dot(values), after.sum();
  share.add(sums);
  if (sums[2] > 0.0) values.array() += (sums[0] - sums[1]) / sums[2];
  share.pores.refresh(*share.ranks, values);
  return values;
}

std::vector<std::size_t> numbers_among_all(const BuiltNetwork& built) {
  const Ranks& ranks = *built.share.ranks;
  const std::vector<PoreRank> own = own_pores_in_order(built);
  std::vector<Ranks::Bytes> to(ranks.count());
  append(to[0], own.data(), own.size());
  std::vector<PoreRank> all;
  for (const Ranks::Bytes& bytes : ranks.hand_over(to))
    for (const PoreRank& rank : values_in<PoreRank>(bytes)) all.push_back(rank);
  std::vector<std::size_t> sorted(all.size()), numbers(all.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) { return all[a] < all[b]; });
  for (std::size_t i = 0; i < sorted.size(); ++i) numbers[sorted[i]] = i;
  return numbers;
}

std::vector<double> pressures_of_all(const BuiltNetwork& built, const Eigen::VectorXd& values) {
  const Ranks& ranks = *built.share.ranks;
  const std::vector<std::size_t> numbers = numbers_among_all(built);
  std::vector<double> own;
  for (int p = 0; p < built.network.pores(); ++p)
    if (built.share.own_pores[p]) own.push_back(values[p]);
  std::vector<Ranks::Bytes> to(ranks.count());
  append(to[0], own.data(), own.size());
  std::vector<double> all(numbers.size());
  std::size_t next = 0;
  for (const Ranks::Bytes& bytes : ranks.hand_over(to))
    for (const double value : values_in<double>(bytes)) all[numbers[next++]] = value;
  return all;
}

Eigen::VectorXd pressures_from_all(const BuiltNetwork& built, const std::vector<std::size_t>& numbers,
                                   const std::vector<double>& all) {
  const Share& share = built.share;
  const Ranks& ranks = *share.ranks;
  const double mine = static_cast<double>(std::count(share.own_pores.begin(), share.own_pores.end(), 1));
  std::vector<Ranks::Bytes> to(ranks.count());
  std::size_t next = 0;
  Ranks::Bytes message;
  append(message, &mine, 1);
  const std::vector<Ranks::Bytes> pores = ranks.gather(message);
  for (int r = 0; ranks.own() == 0 && r < ranks.count(); ++r)
    for (double left = values_in<double>(pores[r])[0]; left > 0.0; --left) append(to[r], &all[numbers[next++]], 1);
  const std::vector<double> own = values_in<double>(ranks.hand_over(to)[0]);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(built.network.pores());
  next = 0;
  for (int p = 0; p < built.network.pores(); ++p)
    if (share.own_pores[p]) values[p] = own[next++];
  share.pores.refresh(ranks, values);
  return values;
}

}  // namespace pfv
