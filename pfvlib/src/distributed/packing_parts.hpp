// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/container.hpp"
#include "pfv/packing.hpp"

#include <vector>

namespace pfv {

/// Spheres that several ranks have in any order, dealt out by place: each rank gets those in a box of its own, about
/// as many as the others (parts_by_place).
class PackingParts {
 public:
  /// `rows`: what this rank has at first; what repeats is dealt out by its places in the cell. Throws InputError for
  /// positions that are not finite. Collective.
  PackingParts(const Packing& rows, const Container& container, const Ranks& ranks);
  /// What it has in the end.
  const PackingArrays& own() const { return own_; }
  /// Values of the own spheres, one column each, back to where their rows came from; none where there are none.
  /// Collective.
  Eigen::Matrix3Xd returned(const Eigen::Matrix3Xd& values) const;

 private:
  const Ranks* ranks_;
  std::vector<std::vector<int>> sent_;  ///< to each rank: rows
  std::vector<int> received_;           ///< from each rank: how many, in its order
  PackingArrays own_;
  Eigen::Index rows_ = 0;
};

}  // namespace pfv
