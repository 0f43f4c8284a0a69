// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/ordering.hpp"

#include "sparse/separator.hpp"
#include "sparse/sparse_error.hpp"

#include <algorithm>
#include <camd.h>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace pfv {
namespace {

/// Parts of this size and less are left to minimum degree.
constexpr int smallest_part = 200;
/// Where a part is cut. Both are tried; measured at 5000 and 20000 spheres, cuts in the middle
/// leave 7 % more fill.
constexpr double first_shares[] = {0.42, 0.58};
/// Share of a part that one side may have after refinement.
constexpr double largest_share = 0.6;
/// Directions this much shorter than the longest one are not cut.
constexpr double shortest_extent = 0.9;
/// Price of sides of unlike size: a separator this share larger for all vertices on one side.
constexpr double imbalance_price = 2.0;

/// So many cuts of a part, those with the fewest vertices along them, are refined.
constexpr int refined_cuts = 2;
/// Levels of the recursion whose cuts are shared among threads; below, parts are.
constexpr int shared_levels = 3;

/// Recursive bisection by planes across the long directions. A part is a range of `vertices_`, and is
/// left as its first side, its second side and the separator, one after the other.
class Dissection {
 public:
  Dissection(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates, Team& team)
      : matrix_(matrix), coordinates_(coordinates), team_(team), vertices_(matrix.size()),
        ends_group_(matrix.size(), 0) {
    for (int v = 0; v < matrix.size(); ++v) vertices_[v] = v;
    for (int thread = 0; thread < team.threads(); ++thread)
      spaces_.push_back(std::make_unique<WorkSpace>(matrix));
    std::vector<Range> parts{{0, matrix.size()}};
    for (int level = 0; level < shared_levels; ++level) {
      std::vector<Range> halves;
      for (const Range& part : parts)
        if (!is_left_whole(part)) put(part, best_cut(part), halves);
      parts = std::move(halves);
    }
    team.run_with_space(static_cast<int>(parts.size()), [&](int part, int thread) {
      dissect(parts[part], *spaces_[thread]);
    });
  }

  /// Of each vertex: vertices of smaller numbers are to be eliminated before it.
  std::vector<int> groups() const {
    std::vector<int> group(vertices_.size());
    int number = 0;
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      group[vertices_[k]] = number;
      number += ends_group_[k];
    }
    return group;
  }

 private:
  struct Range {
    int begin, end;
    int size() const { return end - begin; }
  };

  /// Of one thread. A part's neighbours lie in separators, so that parts may be cut side by side.
  struct WorkSpace {
    explicit WorkSpace(const SymmetricMatrix& matrix)
        : side(matrix.size(), Side::elsewhere), refinement(matrix, side) {}
    std::vector<Side> side;
    SeparatorRefinement refinement;
  };

  /// A part cut by a plane; `separator`: the vertices of one side that touch the other.
  struct Cut {
    int axis;
    double share;
    std::vector<int> first, second, separator;
  };

  /// A part in three runs: first side, second side, separator.
  struct Bisection {
    std::vector<int> vertices;
    int first = 0, second = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  bool is_left_whole(const Range& part) {
    if (part.size() > smallest_part) return false;
    if (part.size() > 0) ends_group_[part.end - 1] = 1;
    return true;
  }

  void put(const Range& part, const Bisection& best, std::vector<Range>& halves) {
    std::copy(best.vertices.begin(), best.vertices.end(), vertices_.begin() + part.begin);
    const int second = part.begin + best.first, separator = second + best.second;
    halves.push_back({part.begin, second});
    halves.push_back({second, separator});
    if (separator < part.end) ends_group_[part.end - 1] = 1;
  }

  void dissect(const Range& part, WorkSpace& space) {
    if (is_left_whole(part)) return;
    std::vector<Cut> cuts = cuts_of(part);
    for (Cut& cut : cuts) make(part, cut, space);
    Bisection best;
    for (const Cut* cut : narrowest(cuts)) {
      Bisection bisection = refined(*cut, space);
      if (bisection.cost < best.cost) best = std::move(bisection);
    }
    std::vector<Range> halves;
    put(part, best, halves);
    for (const Range& half : halves) dissect(half, space);
  }

  /// As in `dissect`, shared.
  Bisection best_cut(const Range& part) {
    std::vector<Cut> cuts = cuts_of(part);
    team_.run_with_space(static_cast<int>(cuts.size()), [&](int k, int thread) {
      make(part, cuts[k], *spaces_[thread]);
    });
    const std::vector<const Cut*> chosen = narrowest(cuts);
    std::vector<Bisection> bisections(chosen.size());
    team_.run_with_space(static_cast<int>(chosen.size()), [&](int k, int thread) {
      bisections[k] = refined(*chosen[k], *spaces_[thread]);
    });
    return *std::min_element(bisections.begin(), bisections.end(),
                             [](const auto& a, const auto& b) { return a.cost < b.cost; });
  }

  std::vector<Cut> cuts_of(const Range& part) const {
    Eigen::Vector3d lower = coordinates_.col(vertices_[part.begin]), upper = lower;
    for (int k = part.begin; k < part.end; ++k) {
      lower = lower.cwiseMin(coordinates_.col(vertices_[k]));
      upper = upper.cwiseMax(coordinates_.col(vertices_[k]));
    }
    const Eigen::Vector3d extents = upper - lower;
    std::vector<Cut> cuts;
    for (int axis = 0; axis < 3; ++axis) {
      if (extents[axis] < shortest_extent * extents.maxCoeff()) continue;
      for (const double share : first_shares) cuts.push_back({axis, share, {}, {}, {}});
    }
    return cuts;
  }

  void make(const Range& part, Cut& cut, WorkSpace& space) const {
    std::vector<std::pair<double, int>> places;
    places.reserve(part.size());
    for (int k = part.begin; k < part.end; ++k)
      places.emplace_back(coordinates_(cut.axis, vertices_[k]), vertices_[k]);
    const auto middle = places.begin() + static_cast<int>(cut.share * part.size());
    std::nth_element(places.begin(), middle, places.end());
    for (auto p = places.begin(); p != middle; ++p) cut.first.push_back(p->second);
    for (auto p = middle; p != places.end(); ++p) cut.second.push_back(p->second);
    // along the cut, found from the side with fewer vertices
    std::vector<int>& fewer = cut.first.size() <= cut.second.size() ? cut.first : cut.second;
    std::vector<int>& more = &fewer == &cut.first ? cut.second : cut.first;
    for (const int v : fewer) space.side[v] = Side::first;
    for (const int v : more) space.side[v] = Side::second;
    std::vector<int> one, other;
    for (const int v : fewer) {
      bool touches = false;
      for (int k = matrix_.row_begin[v]; k < matrix_.row_begin[v + 1]; ++k) {
        const int w = matrix_.column[k];
        if (space.side[w] == Side::second || space.side[w] == Side::separator) touches = true;
        if (space.side[w] != Side::second) continue;
        space.side[w] = Side::separator;
        other.push_back(w);
      }
      if (touches) one.push_back(v);
    }
    cut.separator = one.size() <= other.size() ? std::move(one) : std::move(other);
    for (const int v : fewer) space.side[v] = Side::elsewhere;
    for (const int v : more) space.side[v] = Side::elsewhere;
  }

  static std::vector<const Cut*> narrowest(const std::vector<Cut>& cuts) {
    std::vector<const Cut*> chosen;
    for (const Cut& cut : cuts) chosen.push_back(&cut);
    std::stable_sort(chosen.begin(), chosen.end(), [](const Cut* a, const Cut* b) {
      return a->separator.size() < b->separator.size();
    });
    chosen.resize(std::min<std::size_t>(chosen.size(), refined_cuts));
    return chosen;
  }

  Bisection refined(const Cut& cut, WorkSpace& space) const {
    for (const int v : cut.first) space.side[v] = Side::first;
    for (const int v : cut.second) space.side[v] = Side::second;
    const auto size = static_cast<int>(cut.first.size() + cut.second.size());
    space.refinement.refine(cut.separator, static_cast<int>(cut.first.size()),
                            static_cast<int>(cut.second.size()),
                            static_cast<int>(largest_share * size));
    Bisection result;
    result.vertices.reserve(size);
    std::vector<int> second, separator;
    for (const std::vector<int>* half : {&cut.first, &cut.second})
      for (const int v : *half) {
        const Side side = space.side[v];
        (side == Side::first ? result.vertices : side == Side::second ? second : separator)
            .push_back(v);
        space.side[v] = Side::elsewhere;
      }
    result.first = static_cast<int>(result.vertices.size());
    result.second = static_cast<int>(second.size());
    result.vertices.insert(result.vertices.end(), second.begin(), second.end());
    result.vertices.insert(result.vertices.end(), separator.begin(), separator.end());
    const double imbalance = static_cast<double>(result.first - result.second) / size;
    result.cost =
        static_cast<double>(separator.size()) * (1.0 + imbalance_price * imbalance * imbalance);
    return result;
  }

  const SymmetricMatrix& matrix_;
  const Eigen::Matrix3Xd& coordinates_;
  Team& team_;
  std::vector<std::unique_ptr<WorkSpace>> spaces_;
  std::vector<int> vertices_;
  std::vector<char> ends_group_;  ///< by places in `vertices_`
};

}  // namespace

std::vector<int> geometric_ordering(const SymmetricMatrix& matrix,
                                    const Eigen::Matrix3Xd& coordinates, Team& team) {
  std::vector<int> permutation(matrix.size());
  if (matrix.size() == 0) return permutation;
  if (coordinates.cols() != matrix.size()) {
    throw SparseError("geometric: the ordering needs the place of each of " +
                      std::to_string(matrix.size()) + " unknowns and was given " +
                      std::to_string(coordinates.cols()) + "; use the ordering metis");
  }
  std::vector<int> groups = Dissection(matrix, coordinates, team).groups();
  const int status = camd_order(matrix.size(), matrix.row_begin.data(), matrix.column.data(),
                                permutation.data(), nullptr, nullptr, groups.data());
  if (status != CAMD_OK && status != CAMD_OK_BUT_JUMBLED) {
    throw SparseError("geometric: minimum degree on " + std::to_string(matrix.size()) +
                      " unknowns failed with code " + std::to_string(status) +
                      "; use the ordering metis");
  }
  return permutation;
}

std::vector<int> geometric_ordering(const SymmetricMatrix& matrix,
                                    const Eigen::Matrix3Xd& coordinates) {
  Team alone;
  return geometric_ordering(matrix, coordinates, alone);
}

}  // namespace pfv
