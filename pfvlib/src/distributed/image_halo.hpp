// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/halo.hpp"
#include "problem/lattice.hpp"

#include <cstdint>
#include <unordered_set>
#include <vector>

namespace pfv {

/// A grain of a halo, so many periods away from its place in the cell.
struct GrainImage {
  int column;  ///< of `Halo::seen`
  Lattice::Shift shift;
  bool is_near = false;  ///< an own grain's, within the margin around the cell
};

/// What a rank knows of a packing that repeats: the images of its own grains within a margin around the cell, and all
/// images of grains, its own ones among them, around these.
class ImageHalo {
 public:
  struct Reach {
    double margin, width;  ///< around the cell; around the images within that margin, m
  };
  /// `own`: this rank's grains in the cell, to be kept as long as this; `halo` takes in what ghosts there are. Collective.
  ImageHalo(Halo& halo, const ActiveGrains& own, Reach reach, const Ranks& ranks);

  const std::vector<GrainImage>& images() const { return images_; }
  /// Whether all images are known whose centres are in a ball.
  bool is_known(const Eigen::Vector3d& centre, double radius) const;
  /// Asks for images of less power than these balls', up to four for each; whether any rank got new ones. Collective.
  bool ask(const std::vector<Halo::Query>& balls);

 private:
  using Lists = std::vector<std::vector<GrainImage>>;

  void take_near_images(Reach reach);
  void tell_what_is_known();
  bool lend(const Lists& images);
  bool tell(int rank, int column, const Lattice::Shift& shift);
  Eigen::Vector3d window_of(const Halo::Query& ball) const;
  std::vector<GrainImage> answers(const std::vector<Halo::Query>& balls, int asker);

  Halo* halo_;
  const ActiveGrains* own_;
  const Ranks* ranks_;
  Lattice lattice_;
  std::vector<Bounds> places_;  ///< of each rank's grains in the cell
  std::vector<Bounds> known_;
  std::vector<std::unordered_set<std::uint64_t>> told_;  ///< to each rank: images of own grains
  std::vector<GrainImage> images_;
};

}  // namespace pfv
