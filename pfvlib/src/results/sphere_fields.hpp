// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/fields.hpp"
#include "results/balance.hpp"

#include <Eigen/Core>
#include <vector>

namespace pfv {

/// What fields of spheres are made of. `packed`: spheres in the packing.
struct SphereFieldSources {
  const BuiltNetwork& built;
  const Solution& solution;
  const Balance& balance;
  Eigen::Index packed;
};

/// See Flow::sphere_fields.
std::vector<Field> sphere_fields(const SphereFieldSources& from);

}  // namespace pfv
