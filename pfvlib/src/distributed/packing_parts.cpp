// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/packing_parts.hpp"

#include "distributed/sphere_records.hpp"
#include "pfv/error.hpp"
#include "pfv/ranks.hpp"
#include "problem/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pfv {

namespace {

/// Ranks first ... last - 1, whose places have not been divided yet.
struct RankGroup {
  int first, last;
  int middle() const { return first + (last - first) / 2; }
};

/// For each group the axis along which its places reach furthest, and from where to where.
struct Extent {
  int axis = 0;
  double low = 0.0, high = 0.0;
};

std::vector<Extent> extents_of(const std::vector<RankGroup>& groups, const std::vector<int>& group_of,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& places, const Ranks& ranks) {
  const auto count = static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd reach = Eigen::MatrixXd::Constant(6, count, -std::numeric_limits<double>::infinity());
  for (Eigen::Index k = 0; k < places.cols(); ++k) {
    auto own = reach.col(group_of[k]);
    own.head<3>() = own.head<3>().cwiseMax(places.col(k));
    own.tail<3>() = own.tail<3>().cwiseMax(-places.col(k));
  }
  ranks.take_largest(reach.data(), static_cast<std::size_t>(reach.size()));
  std::vector<Extent> extents;
  for (Eigen::Index g = 0; g < count; ++g) {
    Extent extent;
    (reach.col(g).head<3>() + reach.col(g).tail<3>()).maxCoeff(&extent.axis);
    extent.low = -reach(3 + extent.axis, g);
    extent.high = reach(extent.axis, g);
    extents.push_back(extent);
  }
  return extents;
}

Eigen::VectorXd counts_below(const std::vector<Extent>& extents, const Eigen::VectorXd& cuts,
                             const std::vector<int>& group_of, const Eigen::Ref<const Eigen::Matrix3Xd>& places,
                             const Ranks& ranks) {
  Eigen::VectorXd below = Eigen::VectorXd::Zero(cuts.size());
  for (Eigen::Index k = 0; k < places.cols(); ++k)
    below[group_of[k]] += places(extents[group_of[k]].axis, k) < cuts[group_of[k]];
  ranks.add(below.data(), static_cast<std::size_t>(below.size()));
  return below;
}

/// Where each group is cut, so that both halves of its ranks have their share of its places.
Eigen::VectorXd cuts_of(const std::vector<RankGroup>& groups, const std::vector<Extent>& extents,
                        const std::vector<int>& group_of, const Eigen::Ref<const Eigen::Matrix3Xd>& places,
                        const Ranks& ranks) {
  constexpr int halvings = 40;
  const auto count = static_cast<Eigen::Index>(groups.size());
  Eigen::VectorXd total = Eigen::VectorXd::Zero(count), low(count), high(count);
  for (Eigen::Index k = 0; k < places.cols(); ++k) ++total[group_of[k]];
  ranks.add(total.data(), static_cast<std::size_t>(count));
  for (Eigen::Index g = 0; g < count; ++g) {
    low[g] = extents[g].low;
    high[g] = extents[g].high;
  }
  for (int i = 0; i < halvings; ++i) {
    const Eigen::VectorXd cuts = 0.5 * (low + high);
    const Eigen::VectorXd below = counts_below(extents, cuts, group_of, places, ranks);
    for (Eigen::Index g = 0; g < count; ++g) {
      const double share = static_cast<double>(groups[g].middle() - groups[g].first) / (groups[g].last - groups[g].first);
      (below[g] < share * total[g] ? low : high)[g] = cuts[g];
    }
  }
  return high;
}

}  // namespace

std::vector<int> parts_by_place(const Eigen::Ref<const Eigen::Matrix3Xd>& places, const Ranks& ranks) {
  std::vector<RankGroup> groups{{0, ranks.count()}};
  std::vector<int> group_of(static_cast<std::size_t>(places.cols()), 0);
  while (std::any_of(groups.begin(), groups.end(), [](const RankGroup& g) { return g.last - g.first > 1; })) {
    const std::vector<Extent> extents = extents_of(groups, group_of, places, ranks);
    const Eigen::VectorXd cuts = cuts_of(groups, extents, group_of, places, ranks);
    std::vector<RankGroup> halves;
    std::vector<int> lower(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
      lower[g] = static_cast<int>(halves.size());
      if (groups[g].last - groups[g].first == 1) {
        halves.push_back(groups[g]);
        continue;
      }
      halves.push_back({groups[g].first, groups[g].middle()});
      halves.push_back({groups[g].middle(), groups[g].last});
    }
    for (Eigen::Index k = 0; k < places.cols(); ++k) {
      const int g = group_of[k];
      const bool divided = groups[g].last - groups[g].first > 1;
      group_of[k] = lower[g] + (divided && places(extents[g].axis, k) >= cuts[g]);
    }
    groups = std::move(halves);
  }
  std::vector<int> rank_of;
  for (const int g : group_of) rank_of.push_back(groups[g].first);
  return rank_of;
}

namespace {

/// Where the spheres stand or, with periodic axes, those of their images in the cell.
Eigen::Matrix3Xd places_in_cell(const Packing& rows, const Container& container) {
  Eigen::Matrix3Xd places = rows.positions;
  const Lattice lattice{container.upper - container.lower, container.tilt, container.periodic};
  if (!container.any_periodic() || !(lattice.edges.array() > 0.0).all()) return places;
  for (auto place : places.colwise())
    place -= lattice.displacement(lattice.periods(place - container.lower, [](double x) { return std::floor(x); }));
  return places;
}

}  // namespace

PackingParts::PackingParts(const Packing& rows, const Container& container, const Ranks& ranks)
    : ranks_(&ranks), sent_(ranks.count()), rows_(rows.size()) {
  ranks.together([&] {
    for (Eigen::Index k = 0; k < rows.size(); ++k)
      if (!rows.positions.col(k).allFinite())
        throw InputError("sphere " + std::to_string(rows.ids[k]) + ": its position is not finite", {{rows.ids[k]}, {}});
  });
  const std::vector<int> rank_of = parts_by_place(places_in_cell(rows, container), ranks);
  for (std::size_t k = 0; k < rank_of.size(); ++k) sent_[rank_of[k]].push_back(static_cast<int>(k));
  own_ = handed_over(rows, sent_, received_, ranks);
}

Eigen::Matrix3Xd PackingParts::returned(const Eigen::Matrix3Xd& values) const {
  if (!ranks_->any(values.cols() > 0)) return Eigen::Matrix3Xd(3, 0);
  std::vector<Ranks::Bytes> to(ranks_->count());
  Eigen::Index next = 0;
  for (int r = 0; r < ranks_->count(); ++r) {
    append(to[r], values.data() + 3 * next, 3 * static_cast<std::size_t>(received_[r]));
    next += received_[r];
  }
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  Eigen::Matrix3Xd rows(3, rows_);
  for (int r = 0; r < ranks_->count(); ++r) {
    const std::vector<double> part = values_in<double>(from[r]);
    for (std::size_t i = 0; i < sent_[r].size(); ++i)
      rows.col(sent_[r][i]) = Eigen::Map<const Eigen::Vector3d>(&part[3 * i]);
  }
  return rows;
}

}  // namespace pfv
