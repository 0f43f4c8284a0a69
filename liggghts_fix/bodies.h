// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies of several spheres (fix multisphere, fix rigid): what of them counts for the flow.
#ifndef LMP_PFV_BODIES_H
#define LMP_PFV_BODIES_H

#include "body_sources.h"
#include "flow_ranks.h"
#include "grain_exchange.h"

#include "pfv/flow_model.hpp"

#include "pointers.h"

#include <map>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class PfvBodies : protected Pointers {
 public:
  explicit PfvBodies(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Finds the bodies of the grains just gathered, `gravity` (m/s²) acting on those that carry their own weight,
  /// and gives these grains their share of the body's volume and a mass that stands for the body's where a model
  /// knows no bodies. Collective; without a fix of bodies it costs nothing. Each body is looked at by one rank; where all
  /// hold the flow, all come to know of it, some 0.3 kB a body.
  void apply(const PfvGroups& groups, const Eigen::Vector3d& gravity, const PfvHomes& homes, const PfvFlowRanks& ranks,
             PfvGrainExchange& grains);

  // where the flow is

  /// In the order of Packing::bodies, with the arms of this rank's grains.
  const std::vector<pfv::RigidBody>& rigid() const { return rigid_; }
  /// Why the flow cannot take long steps with these bodies, or nothing.
  const std::string& obstacle() const { return obstacle_; }
  /// One more, which no force moves, for spheres that are no grains; after `apply`.
  void add_held(const pfv::RigidBody& body) { rigid_.push_back(body); }
  /// Volumes are found anew from the places of the spheres, which round-off tells from those before.
  void forget() { known_.clear(); }

 private:
  /// The spheres of one body that are in the flow.
  struct Held {
    std::vector<const PfvMember*> members;  ///< by tag
    bool free = false;
  };
  struct Volumes {
    std::vector<std::int64_t> tags;
    Eigen::VectorXd radii, volumes;
  };
  /// What a grain is told of its body: one row of what goes to its home.
  struct OfGrain {
    double tag, number, mass, volume;
    double arm[3];
  };

  void look_at(const PfvBodyList& list, const Eigen::Vector3d& gravity, int first, std::vector<OfGrain>& told,
               std::vector<int>& homes);
  void add(const PfvBodyKey& key, const PfvBody& body, const Held& held, const Eigen::Vector3d& gravity);
  void add_loads_from_outside(const PfvBodyList& list, const std::map<PfvBodyKey, int>& places);
  Eigen::VectorXd volumes_of(const PfvBodyKey& key, const PfvBody& body, const Held& held);
  void share_bodies(const PfvFlowRanks& ranks);
  void tell(const std::vector<OfGrain>& told, std::vector<int> homes, PfvGrainExchange& grains);

  std::vector<pfv::RigidBody> rigid_;
  std::string obstacle_;
  std::map<PfvBodyKey, Volumes> known_;
};

}  // namespace LAMMPS_NS

#endif
