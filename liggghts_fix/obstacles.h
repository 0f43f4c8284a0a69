// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that stand among the grains: as spheres of rigid bodies that move as the meshes do.
#ifndef LMP_PFV_OBSTACLES_H
#define LMP_PFV_OBSTACLES_H

#include "arguments.h"
#include "bodies.h"
#include "flow_ranks.h"
#include "grain_exchange.h"
#include "mesh_motion.h"

#include "pfv/obstacle.hpp"

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

class PfvObstacles : protected Pointers {
 public:
  explicit PfvObstacles(class LAMMPS* lmp) : Pointers(lmp), motions_(lmp) {}

  bool any() const { return !held_.empty(); }
  /// Finds the meshes, and the spheres for those that have none yet or another shape than before; `groupbit`: of the
  /// flow's grains. Throws pfv::InputError, the same on all ranks. Collective.
  void bind(const PfvSettings& settings, int groupbit);
  /// Where the meshes are now. Throws pfv::InputError, the same on all ranks, for one that was deformed. Collective.
  void read();

  // where the flow is, on rank 0 or on all with a part of the spheres each

  /// All spheres that stand for the meshes where these are now, to be dealt out to ranks, and the rank of each.
  Eigen::Matrix3Xd spheres() const;
  void deal(const std::vector<int>& ranks, int own);
  /// Whether there are spheres that have not been dealt out.
  bool are_undealt() const;
  /// Those that this rank has.
  Eigen::Matrix3Xd own_spheres() const;
  /// Puts the spheres behind the gathered grains, and their bodies behind the others.
  void add_to(PfvGrainExchange& grains, PfvBodies& bodies, const pfv::Container& container);
  /// The fluid's force on each, from the last flow call; collective.
  void take_loads(const PfvGrainExchange& grains, const pfv::Forces& forces, const PfvFlowRanks& ranks);
  /// Adds them to what the meshes' stress modules record in this step; rank 0.
  void push() const;
  /// Force (0-2, N) and moment about its centre (3-5, N m) on each in turn.
  double load(int component) const;
  Eigen::Vector3d force() const;  ///< of the fluid on all of them, N
  std::vector<class FixMeshSurface*> meshes() const;
  int components() const { return 6 * static_cast<int>(held_.size()); }

  /// Numbers that change with their places.
  std::vector<double> places() const;
  /// What became of each mesh, since the last call.
  std::vector<std::string> news();

  /// How they move, kept from run to run.
  PfvMeshMotions& motions() { return motions_; }
  /// A line for each that grains of these stick in. Where the flow is.
  std::vector<std::string> stuck_grains(const pfv::Packing& grains, const PfvFlowRanks& ranks) const;
  /// A line for each whose surface moves while it stays, which the fluid does not see.
  std::vector<std::string> surfaces_at_rest() const;

  /// For the restart file: the spheres, and where the meshes were when these were found.
  std::vector<double> record() const;
  void restore(const std::vector<double>& record);

 private:
  struct Held {
    std::string id;
    class FixMeshSurface* mesh = nullptr;
    std::vector<pfv::Triangle> reference;  ///< the mesh as it was when its spheres were found
    pfv::Obstacle obstacle;
    pfv::ObstacleMotion motion;
    std::vector<int> own;  ///< the spheres that this rank has
    bool dealt = false;    ///< to ranks; else all are rank 0's
    bool fresh = false;  ///< not spoken of yet
    bool read = false;   ///< since it was bound
    pfv::ObstacleLoad load;
  };
  class FixMeshSurface* mesh_named(const std::string& id) const;
  double usual_diameter(const std::string& what, int groupbit) const;
  bool has_kept_its_shape(const Held& held, const std::vector<pfv::Triangle>& now, const std::string& what) const;

  PfvMeshMotions motions_;
  std::vector<Held> held_;
};

}  // namespace LAMMPS_NS

#endif
