// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/packing_parts.hpp"
#include "distributed/sphere_records.hpp"
#include "parallel/ranks.hpp"
#include "pfv/dense_packing.hpp"
#include "pfv/ranks.hpp"
#include "pfv/packing.hpp"
#include "support/packings.hpp"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <type_traits>
#include <vector>

/// The ranks that the tests run on.
std::shared_ptr<const pfv::Ranks> world();

/// ./test.sh long sets PFV_LONG: then all is in full size.
template <class T>
T in_long(T full, std::common_type_t<T> otherwise) {
  return std::getenv("PFV_LONG") ? full : otherwise;
}

/// As every rank makes it, of which a quarter of the sweeps makes a bed too, whose spheres overlap somewhat more.
inline pfv::PackingArrays dense_bed(int spheres) { return pfv::dense_packing(spheres, 0.6, 0.2, 1, in_long(400, 100)); }

/// How a packing that every rank has is dealt out.
enum class Deal { by_place, at_random, all_to_one };

inline const std::vector<Deal> every_deal{Deal::by_place, Deal::at_random, Deal::all_to_one};

/// Columns of this rank.
inline std::vector<int> own_columns(const pfv::PackingArrays& packing, Deal deal) {
  const pfv::Ranks& ranks = *world();
  std::vector<int> columns;
  std::vector<int> rank_of(static_cast<std::size_t>(packing.ids.size()), 0);
  if (deal == Deal::by_place) rank_of = pfv::parts_by_place(packing.positions, ranks);
  support::Random random(7);
  if (deal == Deal::at_random)
    for (int& rank : rank_of) rank = std::min(ranks.count() - 1, static_cast<int>(random(0.0, ranks.count())));
  if (deal == Deal::all_to_one)
    for (int& rank : rank_of) rank = ranks.count() - 1;
  for (std::size_t k = 0; k < rank_of.size(); ++k)
    if (rank_of[k] == ranks.own()) columns.push_back(static_cast<int>(k));
  return columns;
}

inline pfv::PackingArrays part_of(const pfv::PackingArrays& packing, const std::vector<int>& columns) {
  return pfv::columns_of(packing, columns);
}

/// Velocities and spins drawn at random, m/s and rad/s.
inline void set_in_motion(pfv::PackingArrays& packing, std::uint64_t seed) {
  support::Random random(seed);
  packing.velocities.resize(3, packing.ids.size());
  packing.angular_velocities.resize(3, packing.ids.size());
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    packing.velocities.col(k) = random.in_cube();
    packing.angular_velocities.col(k) = random.in_cube();
  }
}
