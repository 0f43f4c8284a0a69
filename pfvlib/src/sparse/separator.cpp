// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/separator.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace pfv {
namespace {

/// Passes end at the first that gains nothing; more than these rarely do.
constexpr int most_passes = 6;
/// Moves without a smaller separator after which a pass gives up.
constexpr int moves_without_gain = 100;

constexpr int number(Side side) { return static_cast<int>(side); }

}  // namespace

/// By how much the separator shrinks when `vertex` leaves it.
int SeparatorRefinement::gain(int vertex, Side to) const {
  int gain = 1;
  const Side other = opposite(to);
  for (int k = graph_.row_begin[vertex]; k < graph_.row_begin[vertex + 1]; ++k) {
    gain -= side_[graph_.column[k]] == other;
  }
  return gain;
}

void SeparatorRefinement::push(int vertex) {
  for (const Side to : {Side::first, Side::second}) {
    candidates_[number(to)][std::min(1 - gain(vertex, to), gains - 1)].push_back(vertex);
  }
}

/// The vertex with the largest gain, `lowest` at least, or -1. Entries are out of date where the
/// vertex has left or its gain has fallen; where it has risen there is a second one.
int SeparatorRefinement::pop(Side to, int lowest) {
  for (int loss = 0; loss < gains && 1 - loss >= lowest; ++loss) {
    auto& candidates = candidates_[number(to)][loss];
    while (!candidates.empty()) {
      const int vertex = candidates.back();
      if (side_[vertex] == Side::separator && !locked_[vertex]) {
        const int now = std::min(1 - gain(vertex, to), gains - 1);
        if (now <= loss) return vertex;
        candidates_[number(to)][now].push_back(vertex);
      }
      candidates.pop_back();
    }
  }
  return -1;
}

void SeparatorRefinement::move(int vertex, Side to) {
  const Side other = opposite(to);
  side_[vertex] = to;
  locked_[vertex] = 1;
  ++size_[number(to)];
  --size_[number(Side::separator)];
  int pulled = 0;
  for (int k = graph_.row_begin[vertex]; k < graph_.row_begin[vertex + 1]; ++k) {
    const int neighbour = graph_.column[k];
    if (side_[neighbour] != other) continue;
    side_[neighbour] = Side::separator;
    --size_[number(other)];
    ++size_[number(Side::separator)];
    pulled_.push_back(neighbour);
    separator_.push_back(neighbour);
    ++pulled;
  }
  moves_.push_back({vertex, to, pulled});
  for (auto drawn = pulled_.end() - pulled; drawn != pulled_.end(); ++drawn) {
    if (!locked_[*drawn]) push(*drawn);
    for (int k = graph_.row_begin[*drawn]; k < graph_.row_begin[*drawn + 1]; ++k) {
      const int near = graph_.column[k];
      if (near != *drawn && side_[near] == Side::separator && !locked_[near]) push(near);
    }
  }
}

void SeparatorRefinement::undo() {
  const Move last = moves_.back();
  moves_.pop_back();
  for (int k = 0; k < last.pulled; ++k) {
    side_[pulled_.back()] = opposite(last.to);
    pulled_.pop_back();
  }
  size_[number(opposite(last.to))] += last.pulled;
  size_[number(Side::separator)] += 1 - last.pulled;
  --size_[number(last.to)];
  side_[last.vertex] = Side::separator;
  locked_[last.vertex] = 0;
}

void SeparatorRefinement::pass(int largest) {
  for (auto& side : candidates_) {
    for (auto& candidates : side) candidates.clear();
  }
  moves_.clear();
  pulled_.clear();
  for (const int vertex : separator_) push(vertex);
  const auto difference = [&] { return std::abs(size_[0] - size_[1]); };
  int best = size_[number(Side::separator)], best_difference = difference();
  std::size_t best_moves = 0;
  while (moves_.size() < best_moves + moves_without_gain) {
    Side to = size_[0] <= size_[1] ? Side::first : Side::second;  // of equals, the smaller set
    int vertex = pop(to, -gains);
    const int here = vertex < 0 ? -gains : std::max(gain(vertex, to), 2 - gains);
    const int there = pop(opposite(to), here + 1);
    if (there >= 0 && size_[number(opposite(to))] < largest) {
      to = opposite(to);
      vertex = there;
    }
    if (vertex < 0 || size_[number(to)] >= largest) break;
    move(vertex, to);
    const int now = size_[number(Side::separator)];
    if (now < best || (now == best && difference() < best_difference)) {
      best = now;
      best_difference = difference();
      best_moves = moves_.size();
    }
  }
  for (const Move& move : moves_) locked_[move.vertex] = 0;
  while (moves_.size() > best_moves) undo();
}

void SeparatorRefinement::refine(std::vector<int> separator, int first, int second, int largest) {
  separator_ = std::move(separator);
  size_[number(Side::first)] = first;
  size_[number(Side::second)] = second;
  size_[number(Side::separator)] = static_cast<int>(separator_.size());
  for (const int vertex : separator_) {
    --size_[number(side_[vertex])];
    side_[vertex] = Side::separator;
  }
  for (int k = 0; k < most_passes; ++k) {
    const int before = size_[number(Side::separator)];
    pass(largest);
    if (size_[number(Side::separator)] == before) break;
    const auto left = [&](int vertex) { return side_[vertex] != Side::separator; };
    separator_.erase(std::remove_if(separator_.begin(), separator_.end(), left), separator_.end());
    std::sort(separator_.begin(), separator_.end());
    separator_.erase(std::unique(separator_.begin(), separator_.end()), separator_.end());
  }
}

}  // namespace pfv
