// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/packing_parts.hpp"

#include "network/grains.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace pfv {

namespace {

/// Ranks first ... last - 1, whose places have not been divided yet.
struct Group {
  int first, last;
  int middle() const { return first + (last - first) / 2; }
};

/// For each group the axis along which its places reach furthest, and from where to where.
struct Extent {
  int axis = 0;
  double low = 0.0, high = 0.0;
};

std::vector<Extent> extents_of(const std::vector<Group>& groups, const std::vector<int>& group_of,
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
Eigen::VectorXd cuts_of(const std::vector<Group>& groups, const std::vector<Extent>& extents,
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

std::vector<int> ranks_by_place(const Eigen::Ref<const Eigen::Matrix3Xd>& places, const Ranks& ranks) {
  std::vector<Group> groups{{0, ranks.count()}};
  std::vector<int> group_of(static_cast<std::size_t>(places.cols()), 0);
  while (std::any_of(groups.begin(), groups.end(), [](const Group& g) { return g.last - g.first > 1; })) {
    const std::vector<Extent> extents = extents_of(groups, group_of, places, ranks);
    const Eigen::VectorXd cuts = cuts_of(groups, extents, group_of, places, ranks);
    std::vector<Group> halves;
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

PackingParts::PackingParts(const Packing& rows, const Ranks& ranks)
    : ranks_(&ranks), sent_(ranks.count()), rows_(rows.size()) {
  ranks.together([&] {
    for (Eigen::Index k = 0; k < rows.size(); ++k)
      if (!rows.positions.col(k).allFinite())
        throw InputError("sphere " + std::to_string(rows.ids[k]) + ": its position is not finite", {{rows.ids[k]}, {}});
  });
  const std::vector<int> rank_of = ranks_by_place(rows.positions, ranks);
  for (std::size_t k = 0; k < rank_of.size(); ++k) sent_[rank_of[k]].push_back(static_cast<int>(k));
  deal(rows);
}

namespace {

constexpr std::size_t record = 12;  // id, position, radius, velocity, spin, displaced volume

/// Which of the optional arrays any rank has.
struct Has {
  bool velocities, spins, displaced;
};

Has has_any(const Packing& rows, const Ranks& ranks) {
  Eigen::Vector3d has(rows.velocities.cols() > 0, rows.angular_velocities.cols() > 0, rows.displaced_volumes.size() > 0);
  ranks.take_largest(has.data(), 3);
  return {has[0] > 0.0, has[1] > 0.0, has[2] > 0.0};
}

void append_sphere(Ranks::Bytes& bytes, const Packing& rows, int k) {
  std::array<double, record> values{};
  std::memcpy(values.data(), rows.ids.data() + k, sizeof(double));
  const auto put = [&](std::size_t place, const auto& columns) {
    for (int i = 0; i < 3 && columns.cols() > 0; ++i) values[place + static_cast<std::size_t>(i)] = columns(i, k);
  };
  put(1, rows.positions);
  values[4] = rows.radii[k];
  put(5, rows.velocities);
  put(8, rows.angular_velocities);
  values[11] = displaced_volume(rows, k);
  append(bytes, values.data(), record);
}

/// `values`: records one after the other, from column `first` on.
void take_spheres(PackingArrays& own, const std::vector<double>& values, Eigen::Index first) {
  for (std::size_t i = 0; i < values.size(); i += record, ++first) {
    std::memcpy(own.ids.data() + first, &values[i], sizeof(double));
    own.positions.col(first) = Eigen::Map<const Eigen::Vector3d>(&values[i + 1]);
    own.radii[first] = values[i + 4];
    if (own.velocities.cols() > 0) own.velocities.col(first) = Eigen::Map<const Eigen::Vector3d>(&values[i + 5]);
    if (own.angular_velocities.cols() > 0)
      own.angular_velocities.col(first) = Eigen::Map<const Eigen::Vector3d>(&values[i + 8]);
    if (own.displaced_volumes.size() > 0) own.displaced_volumes[first] = values[i + 11];
  }
}

}  // namespace

void PackingParts::deal(const Packing& rows) {
  const Has has = has_any(rows, *ranks_);
  std::vector<Ranks::Bytes> to(ranks_->count());
  for (int r = 0; r < ranks_->count(); ++r)
    for (const int k : sent_[r]) append_sphere(to[r], rows, k);
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  Eigen::Index total = 0;
  for (const Ranks::Bytes& bytes : from) {
    received_.push_back(static_cast<int>(bytes.size() / (record * sizeof(double))));
    total += received_.back();
  }
  own_.ids.resize(total);
  own_.positions.resize(3, total);
  own_.radii.resize(total);
  own_.velocities.resize(3, has.velocities ? total : 0);
  own_.angular_velocities.resize(3, has.spins ? total : 0);
  own_.displaced_volumes.resize(has.displaced ? total : 0);
  Eigen::Index next = 0;
  for (int r = 0; r < ranks_->count(); ++r) {
    take_spheres(own_, values_in<double>(from[r]), next);
    next += received_[r];
  }
}

Eigen::Matrix3Xd PackingParts::returned(const Eigen::Matrix3Xd& values) const {
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
