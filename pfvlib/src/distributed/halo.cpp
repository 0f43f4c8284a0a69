// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/halo.hpp"

#include "distributed/grain_bins.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace pfv {

namespace {

std::vector<Bounds> bounds_of_all(const Bounds& own, const Ranks& ranks) {
  Ranks::Bytes bytes;
  append_bounds(bytes, own);
  std::vector<Bounds> bounds;
  for (const Ranks::Bytes& message : ranks.gather(bytes)) bounds.push_back(bounds_in(message).front());
  return bounds;
}

}  // namespace

void append_bounds(Ranks::Bytes& bytes, const Bounds& bounds) {
  append(bytes, bounds.lower.data(), 3);
  append(bytes, bounds.upper.data(), 3);
}

std::vector<Bounds> bounds_in(const Ranks::Bytes& bytes) {
  const std::vector<double> values = values_in<double>(bytes);
  std::vector<Bounds> bounds;
  for (std::size_t i = 0; i + 6 <= values.size(); i += 6)
    bounds.push_back({Eigen::Map<const Eigen::Vector3d>(values.data() + i), Eigen::Map<const Eigen::Vector3d>(values.data() + i + 3)});
  return bounds;
}

Halo::Halo(const Packing& own, const Container& container, OutsideGrains outside, const Ranks& ranks)
    : ranks_(&ranks), own_count_(own.size()), origin_(container.lower), lent_(ranks.count()), borrowed_(ranks.count()) {
  ranks.together([&] { check_own(own, container, outside); });
  refuse_shared_ids(own);
  Eigen::Vector3d sums(static_cast<double>(own.size()), static_cast<double>(active_.size()), 0.0);
  double largest = 0.0;
  for (const int k : active_) {
    sums[2] += own.radii[k];
    largest = std::max(largest, own.radii[k]);
  }
  ranks.add(sums.data(), 3);
  totals_ = {sums[0], sums[1], sums[1] > 0.0 ? sums[2] / sums[1] : 0.0, ranks.largest(largest)};
  if (totals_.spheres == 0.0 && outside == OutsideGrains::refuse)
    ranks.together([] { throw InputError("the packing has no spheres; give at least one"); });
  take_own(own);
  share_places(container);
  if (!container.any_periodic()) share_first_ghosts(container);
}

void Halo::check_own(const Packing& own, const Container& container, OutsideGrains outside) {
  active_ = select_grains(own, container, own.size() == 0 ? OutsideGrains::leave_out : outside).columns;
}

/// Ids decide in which order all is numbered and who owns what. Each is sent to one rank, which sees all of its kind.
void Halo::refuse_shared_ids(const Packing& own) const {
  const int count = ranks_->count();
  std::vector<Ranks::Bytes> to(count);
  for (Eigen::Index k = 0; k < own.size(); ++k) {
    const std::int64_t id = own.ids[k];
    append(to[static_cast<std::uint64_t>(id) % static_cast<std::uint64_t>(count)], &id, 1);
  }
  std::vector<std::int64_t> seen;
  for (const Ranks::Bytes& bytes : ranks_->hand_over(to))
    for (const std::int64_t id : values_in<std::int64_t>(bytes)) seen.push_back(id);
  ranks_->together([&] {
    std::sort(seen.begin(), seen.end());
    const auto twice = std::adjacent_find(seen.begin(), seen.end());
    if (twice != seen.end())
      throw InputError("sphere id " + std::to_string(*twice) + " occurs twice; ids must be unique", {{*twice}, {}});
  });
}

void Halo::take_own(const Packing& own) {
  arrays_ = arrays_of_all(own, *ranks_);
  const Eigen::Index n = own.size();
  const auto columns = [&](bool wanted, const auto& values) {
    return values.cols() > 0 ? Eigen::Matrix3Xd(values) : Eigen::Matrix3Xd(Eigen::Matrix3Xd::Zero(3, wanted ? n : 0));
  };
  seen_.ids = own.ids;
  seen_.positions = own.positions;
  seen_.radii = own.radii;
  seen_.velocities = columns(arrays_.velocities, own.velocities);
  seen_.angular_velocities = columns(arrays_.spins, own.angular_velocities);
  seen_.displaced_volumes.resize(arrays_.displaced ? n : 0);
  for (Eigen::Index k = 0; k < seen_.displaced_volumes.size(); ++k)
    seen_.displaced_volumes[k] = displaced_volume(own, k);
  seen_.bodies.resize(arrays_.bodies ? n : 0);
  for (Eigen::Index k = 0; k < seen_.bodies.size(); ++k) seen_.bodies[k] = body_of(own, k);
  owner_.assign(static_cast<std::size_t>(n), ranks_->own());
}

namespace {

/// Of the grains where there are any: the container may reach far beyond a bed, m. Along a periodic axis they are all over.
double mean_distance(const std::vector<Bounds>& places, const Container& container, const Halo::Totals& totals) {
  const Eigen::Vector3d edges = container.upper - container.lower;
  Eigen::Vector3d lower = edges, upper = Eigen::Vector3d::Zero();
  for (const Bounds& place : places)
    if (!place.is_empty()) {
      lower = lower.cwiseMin(place.lower);
      upper = upper.cwiseMax(place.upper);
    }
  Eigen::Vector3d filled = (upper - lower).cwiseMax(0.0).array() + 2.0 * totals.mean_radius;
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis]) filled[axis] = edges[axis];
  return std::cbrt(filled.cwiseMin(edges).prod() / std::max(1.0, totals.active));
}

}  // namespace

void Halo::share_places(const Container& container) {
  Bounds place;
  if (!active_.empty()) {
    const Eigen::Matrix3Xd inside = container.any_periodic() ? Eigen::Matrix3Xd(active_grains(container).spheres.centres)
                                                             : Eigen::Matrix3Xd(seen_.positions(Eigen::all, active_).colwise() - origin_);
    place = {inside.rowwise().minCoeff(), inside.rowwise().maxCoeff()};
  }
  places_ = bounds_of_all(place, *ranks_);
}

double Halo::first_width(const Container& container) const {
  constexpr double mean_distances = 5.5;
  return mean_distances * mean_distance(places_, container, totals_);
}

void Halo::share_first_ghosts(const Container& container) {
  const Bounds& place = places_[ranks_->own()];
  const Eigen::Vector3d edges = container.upper - container.lower;
  const double width = first_width(container);
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  known_ = place;
  for (int axis = 0; axis < 3 && !place.is_empty(); ++axis) {
    known_.lower[axis] = place.lower[axis] > width ? place.lower[axis] - width : -everywhere;
    known_.upper[axis] = place.upper[axis] < edges[axis] - width ? place.upper[axis] + width : everywhere;
  }
  const std::vector<Bounds> wanted = bounds_of_all(known_, *ranks_);
  Lists columns(ranks_->count());
  for (int r = 0; r < ranks_->count(); ++r)
    if (r != ranks_->own() && !wanted[r].is_empty())
      for (const int k : active_)
        if (wanted[r].contains(seen_.positions.col(k) - origin_)) columns[r].push_back(k);
  lend(columns);
}

void Halo::lend(const Lists& columns) {
  std::vector<Ranks::Bytes> to(ranks_->count());
  const Packing seen = seen_.view();
  for (int r = 0; r < ranks_->count(); ++r)
    for (const int k : columns[r]) {
      append_sphere(to[r], seen, k);
      lent_[r].push_back(k);
    }
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  for (int r = 0; r < ranks_->count(); ++r)
    if (r != ranks_->own() && !from[r].empty()) append_ghosts(r, from[r]);
}

void Halo::append_ghosts(int rank, const Ranks::Bytes& bytes) {
  const Eigen::Index before = seen_.ids.size(), n = before + spheres_in(bytes);
  resize(seen_, arrays_, n);
  take_spheres(seen_, bytes, before);
  for (Eigen::Index column = before; column < n; ++column) {
    owner_.push_back(rank);
    borrowed_[rank].push_back(static_cast<int>(column));
  }
}

ActiveGrains Halo::active_grains(const Container& container) const {
  ActiveGrains grains = select_grains(seen_.view(), container, OutsideGrains::leave_out);
  grains.spheres.mean_radius = totals_.mean_radius;
  if (arrays_.bodies) note_bodies(grains, seen_.view());
  return grains;
}

std::vector<int> Halo::answers(const std::vector<Query>& queries, int asker) const {
  std::vector<char> told(static_cast<std::size_t>(own_count_), 0);
  for (const int k : lent_[asker]) told[k] = 1;
  const Bounds& place = places_[ranks_->own()];
  Eigen::Matrix3Xd relative = seen_.positions.leftCols(own_count_).colwise() - origin_;
  const GrainBins bins(relative, active_, place);
  std::vector<int> columns;
  std::vector<std::pair<double, int>> found;
  for (const Query& query : queries) {
    found.clear();
    const double most = query.power + 1e-12 * std::abs(query.power);
    const double reach = std::sqrt(std::max(0.0, most + totals_.largest_radius * totals_.largest_radius));
    bins.near(query.centre, reach, [&](int k) {
      const double power = (relative.col(k) - query.centre).squaredNorm() - seen_.radii[k] * seen_.radii[k];
      if (!told[k] && power < most) found.push_back({power, k});
    });
    std::sort(found.begin(), found.end());
    for (std::size_t i = 0; i < std::min(most_answers, found.size()); ++i) {
      told[found[i].second] = 1;
      columns.push_back(found[i].second);
    }
  }
  return columns;
}

bool Halo::ask(const std::vector<Query>& queries) {
  const int count = ranks_->count();
  std::vector<Ranks::Bytes> to(count);
  for (const Query& query : queries) {
    const double reach = std::sqrt(std::max(0.0, query.power) + totals_.largest_radius * totals_.largest_radius);
    for (int r = 0; r < count; ++r)
      if (r != ranks_->own() && places_[r].meets_ball(query.centre, reach)) append(to[r], &query, 1);
  }
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  Lists columns(count);
  for (int r = 0; r < count; ++r)
    if (!from[r].empty()) columns[r] = answers(values_in<Query>(from[r]), r);
  const std::size_t before = owner_.size();
  lend(columns);
  return ranks_->any(owner_.size() > before);
}

void Halo::keep(const std::vector<char>& wanted) {
  const int count = ranks_->count();
  std::vector<Ranks::Bytes> to(count);
  std::vector<int> columns(static_cast<std::size_t>(own_count_));
  std::iota(columns.begin(), columns.end(), 0);
  Lists borrowed(count);
  for (int r = 0; r < count; ++r)
    for (const int column : borrowed_[r]) {
      const char kept = wanted[column];
      append(to[r], &kept, 1);
      if (!kept) continue;
      borrowed[r].push_back(static_cast<int>(columns.size()));
      columns.push_back(column);
    }
  borrowed_ = std::move(borrowed);
  seen_ = columns_of(seen_, columns);
  std::vector<int> owner;
  for (const int column : columns) owner.push_back(owner_[column]);
  owner_ = std::move(owner);
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  for (int r = 0; r < count; ++r) {
    std::vector<int> kept;
    for (std::size_t i = 0; i < from[r].size(); ++i)
      if (from[r][i]) kept.push_back(lent_[r][i]);
    lent_[r] = std::move(kept);
  }
}

Exchange Halo::exchange() const { return {lent_, borrowed_}; }

void Halo::refresh(const Packing& own) {
  const Eigen::Index n = seen_.ids.size();
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(10, n);
  values.topLeftCorner(3, own_count_) = own.positions;
  values.row(3).head(own_count_) = own.radii;
  if (own.velocities.cols() > 0) values.block(4, 0, 3, own_count_) = own.velocities;
  if (own.angular_velocities.cols() > 0) values.block(7, 0, 3, own_count_) = own.angular_velocities;
  exchange().refresh(*ranks_, values);
  Eigen::Vector2d has(own.velocities.cols() > 0, own.angular_velocities.cols() > 0);
  ranks_->take_largest(has.data(), 2);
  seen_.positions = values.topRows<3>();
  seen_.radii = values.row(3);
  seen_.velocities = values.middleRows(4, 3).leftCols(has[0] > 0.0 ? n : 0);
  seen_.angular_velocities = values.middleRows(7, 3).leftCols(has[1] > 0.0 ? n : 0);
  for (Eigen::Index k = 0; k < seen_.displaced_volumes.size(); ++k)
    if (k < own_count_) seen_.displaced_volumes[k] = displaced_volume(own, k);
}

}  // namespace pfv
