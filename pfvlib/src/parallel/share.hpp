// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/exchange.hpp"

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace pfv {

/// What one of several ranks has of a network: its own pores and spheres, and around them *ghosts*, which are others'.
/// A ghost pore has its owner's pressure and place; what is summed over pores (volumes, rates, bases) is 0 there, since
/// it counts at its owner. Of loads, those on own spheres are whole; those on faces are parts.
struct Share {
  std::shared_ptr<const Ranks> ranks;  ///< null: one rank has all, and nothing below is there
  std::vector<char> own_pores, own_spheres;
  std::vector<char> whole_pores;  ///< own ones and ghosts that have all their throats; only these are exchanged
  std::vector<char> whole_spheres;  ///< those with all cells around them
  Exchange pores, spheres;

  bool owns_pore(int pore) const { return !ranks || own_pores[pore]; }
  bool has_whole(int pore) const { return !ranks || whole_pores[pore]; }
  bool owns_sphere(int sphere) const { return !ranks || own_spheres[sphere]; }
  bool is_whole(int sphere) const { return !ranks || whole_spheres[sphere]; }

  double sum(double part) const { return ranks ? ranks->sum(part) : part; }
  double largest(double part) const { return ranks ? ranks->largest(part) : part; }
  bool any(bool part) const { return ranks ? ranks->any(part) : part; }
  /// Whether this is the lowest rank of those that are.
  bool is_lowest(bool is) const {
    return ranks ? ranks->largest(is ? -ranks->own() : -ranks->count()) == -ranks->own() : is;
  }
  /// Does what each rank does alone; see Ranks::together.
  void together(const std::function<void()>& part) const {
    if (ranks) ranks->together(part);
    else part();
  }
  /// In place.
  void add(Eigen::Ref<Eigen::VectorXd> parts) const {
    if (ranks) ranks->add(parts.data(), static_cast<std::size_t>(parts.size()));
  }
};

/// Values that count once, one a pore: 0 where another rank counts them.
inline void leave_to_owners(const Share& share, Eigen::VectorXd& values) {
  if (!share.ranks) return;
  for (Eigen::Index pore = 0; pore < values.size(); ++pore)
    if (!share.own_pores[static_cast<std::size_t>(pore)]) values[pore] = 0.0;
}

}  // namespace pfv
