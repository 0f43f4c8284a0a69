// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse/symmetric_matrix.hpp"

#include <cstdint>
#include <vector>

namespace pfv {

/// Part of a graph in three sets, no edge between the first two.
enum class Side : std::uint8_t { first, second, separator, elsewhere };

/// Makes a vertex separator small: Fiduccia and Mattheyses' moves (1982) with the separator as the
/// objective, as in METIS' refinement. One object serves any number of parts of one graph; a part
/// costs what the vertices near its separator cost.
class SeparatorRefinement {
 public:
  SeparatorRefinement(const SymmetricMatrix& graph, std::vector<Side>& side)
      : graph_(graph), side_(side), locked_(graph.size(), 0) {}

  /// Separates the first from the second side of a part, whose vertices are given, beginning with
  /// `separator`, all the vertices of one side that touch the other. Neither side grows beyond
  /// `largest`.
  void refine(std::vector<int> separator, int first, int second, int largest);

 private:
  struct Move {
    int vertex;
    Side to;
    int pulled;  ///< vertices that it drew into the separator: the last ones of `pulled_`
  };

  static Side opposite(Side side) { return side == Side::first ? Side::second : Side::first; }
  int gain(int vertex, Side to) const;
  void push(int vertex);
  int pop(Side to, int lowest);
  void move(int vertex, Side to);
  void undo();
  void pass(int largest);

  static constexpr int gains = 5;  ///< 1, 0, -1, -2, and all below
  const SymmetricMatrix& graph_;
  std::vector<Side>& side_;
  std::vector<char> locked_;  ///< moved in this pass
  std::vector<int> candidates_[2][gains];
  std::vector<Move> moves_;
  std::vector<int> pulled_;
  std::vector<int> separator_;  ///< with those that have left it
  int size_[3] = {};
};

}  // namespace pfv
