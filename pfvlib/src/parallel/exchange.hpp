// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// Which entries of an array this rank tells the others, and which they tell it: the values that others own.
struct Exchange {
  std::vector<std::vector<int>> sent, received;  ///< one list a rank, in the same order on both sides

  /// Sets each column that is received to that of its owner.
  template <class Columns>
  void refresh(const Ranks& ranks, Columns&& values) const {
    const auto rows = static_cast<std::size_t>(values.rows());
    std::vector<std::vector<double>> to(sent.size()), from(received.size());
    for (std::size_t r = 0; r < sent.size(); ++r) {
      to[r].reserve(rows * sent[r].size());
      for (const int column : sent[r])
        for (std::size_t row = 0; row < rows; ++row)
          to[r].push_back(values(static_cast<Eigen::Index>(row), column));
      from[r].resize(rows * received[r].size());
    }
    ranks.exchange(to, from);
    for (std::size_t r = 0; r < received.size(); ++r)
      for (std::size_t k = 0; k < received[r].size(); ++k)
        for (std::size_t row = 0; row < rows; ++row)
          values(static_cast<Eigen::Index>(row), received[r][k]) = from[r][rows * k + row];
  }
  /// The other way round: calls take(value, theirs) at each entry that is sent, with what each rank has in its place,
  /// rank after rank.
  template <class Take>
  void give_back(const Ranks& ranks, Eigen::VectorXd& values, const Take& take) const {
    std::vector<std::vector<double>> to(sent.size()), from(sent.size());
    for (std::size_t r = 0; r < sent.size(); ++r) {
      for (const int entry : received[r]) to[r].push_back(values[entry]);
      from[r].resize(sent[r].size());
    }
    ranks.exchange(to, from);
    for (std::size_t r = 0; r < sent.size(); ++r)
      for (std::size_t k = 0; k < sent[r].size(); ++k) take(values[sent[r][k]], from[r][k]);
  }
  /// As above, of a vector.
  void refresh(const Ranks& ranks, Eigen::VectorXd& values) const {
    refresh(ranks, Eigen::Map<Eigen::Matrix<double, 1, Eigen::Dynamic>>(values.data(), values.size()));
  }
};

}  // namespace pfv
