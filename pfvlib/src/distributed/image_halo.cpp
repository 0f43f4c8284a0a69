// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/image_halo.hpp"

#include "distributed/grain_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pfv {

namespace {

constexpr double everywhere = std::numeric_limits<double>::infinity();

/// Shifts with which a box meets another one.
std::vector<Lattice::Shift> shifts_into(const Bounds& target, const Bounds& box, const Lattice& lattice) {
  if (box.is_empty()) return {};
  return lattice.between(target.lower - box.upper, target.upper - box.lower);
}

/// The cell, so much wider along its periodic axes, without end along the others.
Bounds around_cell(const Lattice& lattice, double margin) {
  Bounds bounds{Eigen::Vector3d::Constant(-everywhere), Eigen::Vector3d::Constant(everywhere)};
  for (int axis = 0; axis < 3; ++axis)
    if (lattice.periodic[axis]) {
      bounds.lower[axis] = -margin;
      bounds.upper[axis] = lattice.edges[axis] + margin;
    }
  return bounds;
}

void include(Bounds& bounds, const Eigen::Vector3d& place) {
  const bool first = bounds.is_empty();
  bounds.lower = first ? place : Eigen::Vector3d(bounds.lower.cwiseMin(place));
  bounds.upper = first ? place : Eigen::Vector3d(bounds.upper.cwiseMax(place));
}

/// An image as one number.
std::uint64_t key_of(int column, const Lattice::Shift& shift) {
  std::uint64_t key = static_cast<std::uint32_t>(column);
  for (const int periods : shift) key = key << 10 | (static_cast<std::uint64_t>(periods) & 1023u);
  return key;
}

/// An image on its way: its grain by its place among those that the rank has been told of.
struct ImageRecord {
  std::int32_t place;
  Lattice::Shift shift;
};

}  // namespace

ImageHalo::ImageHalo(Halo& halo, const ActiveGrains& own, Reach reach, const Ranks& ranks)
    : halo_(&halo), own_(&own), ranks_(&ranks), lattice_(own.spheres.lattice()), places_(halo.places()), told_(ranks.count()) {
  take_near_images(reach);
  tell_what_is_known();
}

/// Images of own grains within the margin, and the boxes around those of each shift in which all will be known. Beyond
/// the cell that is wanted as far as the halo is wide alone.
void ImageHalo::take_near_images(Reach reach) {
  const Bounds near = around_cell(lattice_, reach.margin), wanted = around_cell(lattice_, reach.width);
  for (const Lattice::Shift& shift : shifts_into(near, places_[ranks_->own()], lattice_)) {
    Bounds box;
    for (int i = 0; i < own_->spheres.size(); ++i) {
      const Eigen::Vector3d centre = own_->spheres.centres.col(i) + lattice_.displacement(shift);
      if (!near.contains(centre)) continue;
      include(box, centre);
      tell(ranks_->own(), own_->columns[i], shift);
      images_.push_back({own_->columns[i], shift, true});
    }
    if (box.is_empty()) continue;
    Bounds known{box.lower.array() - reach.width, box.upper.array() + reach.width};
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice_.periodic[axis] && known.lower[axis] <= 0.0) known.lower[axis] = -everywhere;
      if (!lattice_.periodic[axis] && known.upper[axis] >= lattice_.edges[axis]) known.upper[axis] = everywhere;
    }
    if (shift != Lattice::here) known = {known.lower.cwiseMax(wanted.lower), known.upper.cwiseMin(wanted.upper)};
    if (!known.is_empty()) known_.push_back(known);
  }
}

void ImageHalo::tell_what_is_known() {
  Ranks::Bytes bytes;
  for (const Bounds& box : known_) append_bounds(bytes, box);
  Lists images(ranks_->count());
  const std::vector<Ranks::Bytes> boxes = ranks_->gather(bytes);
  for (int r = 0; r < ranks_->count(); ++r)
    for (const Bounds& box : bounds_in(boxes[r]))
      for (const Lattice::Shift& shift : shifts_into(box, places_[ranks_->own()], lattice_))
        for (int i = 0; i < own_->spheres.size(); ++i)
          if (box.contains(own_->spheres.centres.col(i) + lattice_.displacement(shift)) &&
              tell(r, own_->columns[i], shift))
            images[r].push_back({own_->columns[i], shift});
  lend(images);
}

/// False for what the rank knows already.
bool ImageHalo::tell(int rank, int column, const Lattice::Shift& shift) {
  return told_[rank].insert(key_of(column, shift)).second;
}

/// Tells others of images of own grains, and takes in what they tell; whether that is anything.
bool ImageHalo::lend(const Lists& images) {
  const std::size_t before = images_.size();
  std::vector<std::vector<int>> columns(ranks_->count());
  std::vector<Ranks::Bytes> to(ranks_->count());
  std::vector<int> place;
  for (int r = 0; r < ranks_->count(); ++r) {
    if (r == ranks_->own()) {
      images_.insert(images_.end(), images[r].begin(), images[r].end());
      continue;
    }
    const std::vector<int>& lent = halo_->lent_to(r);
    place.assign(static_cast<std::size_t>(halo_->own_count()), -1);
    for (std::size_t i = 0; i < lent.size(); ++i) place[lent[i]] = static_cast<int>(i);
    int next = static_cast<int>(lent.size());
    for (const GrainImage& image : images[r]) {
      if (place[image.column] < 0) {
        place[image.column] = next++;
        columns[r].push_back(image.column);
      }
      const ImageRecord record{place[image.column], image.shift};
      append(to[r], &record, 1);
    }
  }
  halo_->lend(columns);
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  for (int r = 0; r < ranks_->count(); ++r)
    for (const ImageRecord& record : values_in<ImageRecord>(from[r]))
      images_.push_back({halo_->borrowed_from(r)[record.place], record.shift});
  return images_.size() > before;
}

bool ImageHalo::is_known(const Eigen::Vector3d& centre, double radius) const {
  return std::any_of(known_.begin(), known_.end(), [&](const Bounds& box) {
    return (centre.array() - radius >= box.lower.array()).all() && (centre.array() + radius <= box.upper.array()).all();
  });
}

/// Half the edges of the block around a ball's centre in which it is enough to look: if any image of a grain reaches
/// into the ball, the nearest one does.
Eigen::Vector3d ImageHalo::window_of(const Halo::Query& ball) const {
  const double largest = halo_->totals().largest_radius;
  const double reach = std::sqrt(std::max(0.0, ball.power) + largest * largest) * (1.0 + 1e-9);
  double around = 0.0;  // no place is farther from a point of a tilted lattice
  for (int axis = 0; axis < 3; ++axis) {
    Lattice::Shift one = Lattice::here;
    one[axis] = 1;
    if (lattice_.periodic[axis]) around += 0.5 * lattice_.displacement(one).norm();
  }
  Eigen::Vector3d window = Eigen::Vector3d::Constant(reach);
  for (int axis = 0; axis < 3; ++axis)
    if (lattice_.periodic[axis])
      window[axis] = std::min(reach, (1.0 + 1e-9) * (lattice_.tilt.isZero(0.0) ? 0.5 * lattice_.edges[axis] : around));
  return window;
}

std::vector<GrainImage> ImageHalo::answers(const std::vector<Halo::Query>& balls, int asker) {
  const Spheres& spheres = own_->spheres;
  const Bounds& place = places_[ranks_->own()];
  std::vector<int> all(static_cast<std::size_t>(spheres.size()));
  std::iota(all.begin(), all.end(), 0);
  const GrainBins bins(spheres.centres, all, place);
  std::vector<GrainImage> images;
  std::vector<std::pair<double, GrainImage>> found;
  for (const Halo::Query& ball : balls) {
    found.clear();
    const double most = ball.power + 1e-12 * std::abs(ball.power);
    const Eigen::Vector3d window = window_of(ball);
    for (const Lattice::Shift& shift : shifts_into({ball.centre - window, ball.centre + window}, place, lattice_)) {
      const Eigen::Vector3d way = lattice_.displacement(shift);
      bins.near(ball.centre - way, window.maxCoeff(), [&](int k) {
        const double power = (spheres.centres.col(k) + way - ball.centre).squaredNorm() - spheres.radii[k] * spheres.radii[k];
        if (power < most && told_[asker].count(key_of(own_->columns[k], shift)) == 0)
          found.push_back({power, {own_->columns[k], shift}});
      });
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first, key_of(a.second.column, a.second.shift)) <
             std::pair(b.first, key_of(b.second.column, b.second.shift));
    });
    for (std::size_t i = 0; i < std::min(Halo::most_answers, found.size()); ++i)
      if (tell(asker, found[i].second.column, found[i].second.shift)) images.push_back(found[i].second);
  }
  return images;
}

bool ImageHalo::ask(const std::vector<Halo::Query>& balls) {
  std::vector<Ranks::Bytes> to(ranks_->count());
  for (const Halo::Query& ball : balls) {
    const Eigen::Vector3d window = window_of(ball);
    for (int r = 0; r < ranks_->count(); ++r)
      if (!shifts_into({ball.centre - window, ball.centre + window}, places_[r], lattice_).empty()) append(to[r], &ball, 1);
  }
  const std::vector<Ranks::Bytes> from = ranks_->hand_over(to);
  Lists images(ranks_->count());
  for (int r = 0; r < ranks_->count(); ++r)
    if (!from[r].empty()) images[r] = answers(values_in<Halo::Query>(from[r]), r);
  return ranks_->any(lend(images));
}

}  // namespace pfv
