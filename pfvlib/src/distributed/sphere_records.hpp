// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/packing.hpp"

#include <vector>

namespace pfv {

// Spheres on their way from one rank to another, and parts of a packing.

/// Which of the optional arrays any rank has: then all have them, with zeros, and -1 for no body. Collective.
struct SphereArrays {
  bool velocities = false, spins = false, displaced = false, bodies = false;
};
SphereArrays arrays_of_all(const Packing& packing, const Ranks& ranks);

/// Sphere k of a packing, all that is known of it.
void append_sphere(Ranks::Bytes& bytes, const Packing& packing, Eigen::Index k);
/// How many spheres a message holds.
Eigen::Index spheres_in(const Ranks::Bytes& bytes);
/// Room for so many columns, what is there kept.
void resize(PackingArrays& packing, const SphereArrays& arrays, Eigen::Index count);
/// Those of a message into columns `first` and on.
void take_spheres(PackingArrays& packing, const Ranks::Bytes& bytes, Eigen::Index first);

/// Hands columns of a packing on, `sent[r]` to rank r, in pieces: what comes from rank 0, then from rank 1 and so on, and how
/// many from each. Collective.
PackingArrays handed_over(const Packing& packing, const std::vector<std::vector<int>>& sent, std::vector<int>& received,
                          const Ranks& ranks);

/// These columns of a packing, in this order.
PackingArrays columns_of(const PackingArrays& packing, const std::vector<int>& columns);

}  // namespace pfv
