// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that stand among the grains: as spheres of rigid bodies that move as the meshes do.
#ifndef LMP_PFV_OBSTACLES_H
#define LMP_PFV_OBSTACLES_H

#include "arguments.h"
#include "bodies.h"
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

  /// Puts the spheres behind the gathered grains, and their bodies behind the others; rank 0.
  void add_to(PfvGrainExchange& grains, PfvBodies& bodies, const pfv::Container& container);
  /// The fluid's force on each, from the last flow call; rank 0.
  void take_loads(const PfvGrainExchange& grains, const pfv::Forces& forces);
  /// Adds them to what the meshes' stress modules record in this step; rank 0.
  void push() const;
  /// Force (0-2, N) and moment about its centre (3-5, N m) on each in turn; rank 0.
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
