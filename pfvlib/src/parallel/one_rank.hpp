// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"

namespace pfv {

/// A program by itself, for what is written once for any number of ranks.
class OneRank final : public Ranks {
 public:
  int count() const override { return 1; }
  int own() const override { return 0; }
  void add(double*, std::size_t) const override {}
  void take_largest(double*, std::size_t) const override {}
  std::vector<Bytes> hand_over(const std::vector<Bytes>& to) const override { return to; }
  void exchange(const std::vector<std::vector<double>>& to, std::vector<std::vector<double>>& from) const override {
    from = to;
  }
  std::shared_ptr<const Ranks> beside() const override { return std::make_shared<OneRank>(); }
};

/// These ranks or, where there are none, one.
inline const Ranks& ranks_or_one(const Ranks* ranks) {
  static const OneRank one;
  return ranks ? *ranks : one;
}

/// What rank 0 has to say to all. Collective.
inline Ranks::Bytes told_by_first(const Ranks& ranks, const Ranks::Bytes& own) {
  return ranks.hand_over(std::vector<Ranks::Bytes>(ranks.count(), ranks.own() == 0 ? own : Ranks::Bytes()))[0];
}

}  // namespace pfv
