// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid bodies of fix multisphere and fix rigid, from all ranks where they are looked at.
#ifndef LMP_PFV_BODY_SOURCES_H
#define LMP_PFV_BODY_SOURCES_H

#include "grain_exchange.h"
#include "other_fixes.h"

#include "pointers.h"

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// The fix (counted among those of bodies) and its own number for the body.
using PfvBodyKey = std::pair<int, int>;

struct PfvBody {
  double spheres = 0.0;  ///< all that it has, in the flow or not
  double mass = 0.0;     ///< kg
  Eigen::Vector3d centre, inertia;  ///< m; kg m², about its axes
  Eigen::Matrix3d axes;             ///< one a column
  Eigen::Vector3d moves, turns;     ///< 1 where forces move it along x, y, z, or torques turn it about them; else 0
  bool weighed = false;             ///< its weight acts on it, not on its spheres
};

/// One of its spheres.
struct PfvMember {
  std::int64_t tag;
  PfvBodyKey body;
  bool in_flow, free;  ///< of the flow's grains; whether the fluid's force on it reaches its body
  int home;       ///< the rank that has it in the flow
  double radius;  ///< m
  Eigen::Vector3d place, force, torque;
};

struct PfvBodyList {
  std::map<PfvBodyKey, PfvBody> bodies;
  std::vector<PfvMember> members;  ///< by tag
};

class PfvBodySources : protected Pointers {
 public:
  explicit PfvBodySources(class LAMMPS* lmp) : Pointers(lmp) {}

  bool any() const { return !fixes().empty(); }
  /// Bodies that have a sphere in the flow, and all their spheres, on the rank that looks at each: rank 0 or, where
  /// all hold the flow, one of these. Collective.
  PfvBodyList gather(const PfvGroups& groups, const PfvHomes& homes) const;

 private:
  std::vector<class Fix*> fixes() const;
  std::vector<double> where_looked_at(const std::vector<double>& mine, int width, int key, bool by_all) const;
  void pack_bodies(int number, Fix& fix, std::vector<double>& rows) const;
  void pack_members(int number, Fix& fix, const PfvGroups& groups, const PfvHomes& homes, std::vector<double>& rows) const;
};

}  // namespace LAMMPS_NS

#endif
