// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/exchange.hpp"
#include "distributed/sphere_records.hpp"
#include "network/grains.hpp"
#include "pfv/container.hpp"
#include "pfv/options.hpp"
#include "pfv/packing.hpp"

#include <array>
#include <vector>

namespace pfv {

/// A box along the axes, m; empty where a lower bound is above its upper one.
struct Bounds {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(1.0), upper = Eigen::Vector3d::Constant(-1.0);

  bool is_empty() const { return (lower.array() > upper.array()).any(); }
  bool contains(const Eigen::Vector3d& place) const {
    return (place.array() >= lower.array()).all() && (place.array() <= upper.array()).all();
  }
  bool meets_ball(const Eigen::Vector3d& centre, double radius) const {
    return !is_empty() && (centre - centre.cwiseMax(lower).cwiseMin(upper)).squaredNorm() <= radius * radius;
  }
};

void append_bounds(Ranks::Bytes& bytes, const Bounds& bounds);
std::vector<Bounds> bounds_in(const Ranks::Bytes& bytes);

/// The grains of this rank and, after them, those of others that it knows: its ghosts.
class Halo {
 public:
  /// Begins with the grains of others up to some five mean distances from its own; with periodic axes with none
  /// (distributed/image_halo.hpp). `own`: this rank's part of a packing, whose columns come first. Throws InputError on
  /// all ranks alike. Collective.
  Halo(const Packing& own, const Container& container, OutsideGrains outside, const Ranks& ranks);

  /// Of all ranks.
  struct Totals {
    double spheres = 0.0, active = 0.0, mean_radius = 0.0, largest_radius = 0.0;
  };
  const Totals& totals() const { return totals_; }

  /// The grains that take part, ghosts among them.
  ActiveGrains active_grains(const Container& container) const;
  Packing seen() const { return seen_.view(); }
  Eigen::Index own_count() const { return own_count_; }
  int owner_of(int column) const { return owner_[column]; }

  /// Width of the first halo, m: in dense packings hardly a cell reaches further.
  double first_width(const Container& container) const;
  /// Where all grains are known, in coordinates from the container's lower corner; as far as the container goes. Not
  /// with periodic axes.
  const Bounds& known() const { return known_; }
  /// Of each rank, what its own grains fill, in these coordinates; in the cell, where that repeats.
  const std::vector<Bounds>& places() const { return places_; }

  static constexpr std::size_t most_answers = 4;  ///< to one query
  /// An empty ball that may reach to grains of others: centre (coordinates as above, m) and power, m².
  struct Query {
    Eigen::Vector3d centre;
    double power;
  };
  /// Asks for grains of less power than that, up to four for each; whether any rank got new ones. Collective.
  bool ask(const std::vector<Query>& queries);
  /// Tells each rank of these own columns, which it must not know yet, and takes in what others tell. Collective.
  void lend(const std::vector<std::vector<int>>& columns);
  /// Own columns that a rank knows, and the columns of its grains here, in the same order on both sides.
  const std::vector<int>& lent_to(int rank) const { return lent_[rank]; }
  const std::vector<int>& borrowed_from(int rank) const { return borrowed_[rank]; }
  /// Forgets ghosts but those that are wanted; `wanted`: one entry a column of `seen`. Collective.
  void keep(const std::vector<char>& wanted);
  /// Which columns of `seen` are told to others, and by others.
  Exchange exchange() const;
  /// Takes over this rank's part as it is now (the same grains) and brings the ghosts' positions, radii and velocities.
  /// Collective.
  void refresh(const Packing& own);

 private:
  using Lists = std::vector<std::vector<int>>;

  void check_own(const Packing& own, const Container& container, OutsideGrains outside);
  void refuse_shared_ids(const Packing& own) const;
  void take_own(const Packing& own);
  void share_places(const Container& container);
  void share_first_ghosts(const Container& container);
  void append_ghosts(int rank, const Ranks::Bytes& bytes);
  std::vector<int> answers(const std::vector<Query>& queries, int asker) const;

  const Ranks* ranks_;
  Eigen::Index own_count_ = 0;
  Eigen::Vector3d origin_;
  Totals totals_;
  PackingArrays seen_;
  SphereArrays arrays_;
  std::vector<int> owner_;   ///< of each column
  std::vector<int> active_;  ///< own columns within the container
  Lists lent_, borrowed_;    ///< of each rank: own columns; columns of ghosts
  Bounds known_;
  std::vector<Bounds> places_;
};

}  // namespace pfv
