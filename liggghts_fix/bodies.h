// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies of several spheres (fix multisphere): what of them counts for a grain of the flow.
#ifndef LMP_PFV_BODIES_H
#define LMP_PFV_BODIES_H

#include "grain_exchange.h"

#include "pointers.h"

#include <map>
#include <vector>

namespace LAMMPS_NS {

class FixMultisphere;

/// The fix multisphere of the simulation, or null.
FixMultisphere* find_multisphere(class Modify* modify);

class PfvBodies : protected Pointers {
 public:
  explicit PfvBodies(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Gives the grains just gathered what they have of their bodies: a mass that stands for the body's in
  /// the limit of the time step and, with `lift`, their share of the body's volume. Collective; without a
  /// fix multisphere it costs nothing.
  void apply(const PfvGroups& groups, bool lift, PfvGrainExchange& grains);

  /// Volumes are found anew from the places of the spheres, which round-off tells from those before.
  void forget() { known_.clear(); }

 private:
  /// Of one body: its spheres, as columns of the packing, and its motion.
  struct Body {
    std::vector<double> numbers;  ///< as gather_bodies sends them
    std::vector<int> columns;
    bool free = false;
  };
  struct Volumes {
    std::vector<std::int64_t> tags;
    Eigen::VectorXd radii, volumes;
  };

  std::vector<double> gather_members(const PfvGroups& groups, FixMultisphere& bodies) const;
  std::vector<double> gather_bodies(FixMultisphere& bodies) const;
  std::vector<double> on_root(const std::vector<double>& mine) const;
  double mass_of(const Body& body, const pfv::Packing& packing) const;
  Eigen::VectorXd volumes_of(int tag, const Body& body, const pfv::Packing& packing);

  std::map<int, Volumes> known_;  // by the body's tag; rank 0
};

}  // namespace LAMMPS_NS

#endif
