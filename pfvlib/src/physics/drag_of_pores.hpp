// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/share.hpp"
#include "physics/conductances.hpp"
#include "physics/force_matrix.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

namespace pfv {

/// The throats around each pore.
struct ThroatLists {
  std::vector<int> begin, throat;

  explicit ThroatLists(const PoreNetwork& network);
};

/// The pores around spheres that move as one, without those of imposed pressure, by a name of each.
struct PoresAround {
  struct Throat {
    std::int64_t pore, other;
    double conductance;
  };
  std::map<std::int64_t, Eigen::Vector3d> sources;  ///< S of the spheres in each, m²
  std::vector<Throat> throats;                      ///< of these pores, each with both ends

  bool has(std::int64_t pore) const { return sources.count(pore) > 0; }
};

/// Where pores around a sphere are looked up.
struct PoreSources {
  const PoreNetwork& network;
  const Conductances& conductances;
  const ForceMatrix& matrix;         ///< S
  const std::vector<char>& imposed;  ///< of each pore, whether its pressure is given
  ThroatLists lists;
  std::vector<std::int64_t> names;   ///< of each pore

  void add(int sphere, PoresAround& around) const;
};

/// S_k G_k^-1 S_k^T of these pores, kg/s. The pores around them hold their pressure, by which it is no larger than the whole
/// network's.
Eigen::Matrix3d drag_of(const PoresAround& around);

/// Names of pores that all ranks know them by; their numbers on one rank. Collective.
std::vector<std::int64_t> pore_names(const PoreNetwork& network, const Share& share);

}  // namespace pfv
