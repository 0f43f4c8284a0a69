// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pfv {

/// Places sorted into cubes, to find those near others.
class GrainBins {
 public:
  /// `places`: columns `columns` of these; about one a bin.
  GrainBins(const Eigen::Matrix3Xd& places, const std::vector<int>& columns, const Bounds& bounds) : lower_(bounds.lower) {
    const Eigen::Vector3d edges = (bounds.upper - bounds.lower).cwiseMax(0.0);
    const double most = std::max(1.0, static_cast<double>(columns.size()));
    // along edges that have a length: grains may lie in a plane or a row
    const double thin = 1e-3 * edges.maxCoeff();
    double space = 1.0;
    int dimensions = 0;
    for (const double edge : edges)
      if (edge > thin) {
        space *= edge;
        ++dimensions;
      }
    size_ = dimensions > 0 ? std::pow(space / most, 1.0 / dimensions) : 1.0;
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>(edges[axis] / size_) + 1;
    begin_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (const int k : columns) ++begin_[bin_of(places.col(k)) + 1];
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    columns_.resize(columns.size());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (const int k : columns) columns_[next[bin_of(places.col(k))]++] = k;
  }

  /// Calls see(column) for those whose bins meet the cube around a ball.
  template <class See>
  void near(const Eigen::Vector3d& centre, double radius, const See& see) const {
    const Eigen::Vector3i first = index_of(centre.array() - radius), last = index_of(centre.array() + radius);
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) {
          const std::size_t bin = number_of(x, y, z);
          for (int i = begin_[bin]; i < begin_[bin + 1]; ++i) see(columns_[i]);
        }
  }

 private:
  Eigen::Vector3i index_of(const Eigen::Vector3d& place) const {
    Eigen::Vector3i index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = static_cast<int>(std::clamp((place[axis] - lower_[axis]) / size_, 0.0, count_[axis] - 1.0));
    return index;
  }
  std::size_t number_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x;
  }
  std::size_t bin_of(const Eigen::Vector3d& place) const {
    const Eigen::Vector3i index = index_of(place);
    return number_of(index[0], index[1], index[2]);
  }

  Eigen::Vector3d lower_;
  double size_ = 1.0;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<int> begin_, columns_;
};

}  // namespace pfv
