// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies of several spheres (fix multisphere, fix rigid): what of them counts for the flow.
#ifndef LMP_PFV_BODIES_H
#define LMP_PFV_BODIES_H

#include "body_sources.h"
#include "grain_exchange.h"

#include "pfv/flow_model.hpp"

#include "pointers.h"

#include <map>
#include <vector>

namespace LAMMPS_NS {

class PfvBodies : protected Pointers {
 public:
  explicit PfvBodies(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Finds the bodies of the grains just gathered, `gravity` (m/s²) acting on those that carry their own weight,
  /// and gives these grains their share of the body's volume and a mass that stands for the body's where a model
  /// knows no bodies. Collective; without a fix of bodies it costs nothing.
  void apply(const PfvGroups& groups, const Eigen::Vector3d& gravity, PfvGrainExchange& grains);

  /// In the order of Packing::bodies; rank 0.
  const std::vector<pfv::RigidBody>& rigid() const { return rigid_; }
  /// Why the flow cannot take long steps with these bodies, or nothing; rank 0.
  const std::string& obstacle() const { return obstacle_; }
  /// One more, which no force moves, for spheres that are no grains; rank 0, after `apply`.
  void add_held(const pfv::RigidBody& body) { rigid_.push_back(body); }
  /// Volumes are found anew from the places of the spheres, which round-off tells from those before.
  void forget() { known_.clear(); }

 private:
  /// The spheres of one body that are in the flow.
  struct Held {
    std::vector<int> columns;  ///< of the packing, ascending
    bool free = false;
  };
  struct Volumes {
    std::vector<std::int64_t> tags;
    Eigen::VectorXd radii, volumes;
  };

  void add(const PfvBodyKey& key, const PfvBody& body, const Held& held, const Eigen::Vector3d& gravity,
           const pfv::Packing& packing);
  void add_loads_from_outside(const PfvBodyList& list, const std::map<PfvBodyKey, int>& numbers);
  Eigen::VectorXd volumes_of(const PfvBodyKey& key, const PfvBody& body, const Held& held,
                             const pfv::Packing& packing);

  std::vector<pfv::RigidBody> rigid_;  // these, too, on rank 0
  std::string obstacle_;
  std::map<PfvBodyKey, Volumes> known_;
};

}  // namespace LAMMPS_NS

#endif
