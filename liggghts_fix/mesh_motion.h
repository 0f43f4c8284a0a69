// SPDX-License-Identifier: GPL-3.0-or-later
// How meshes move as rigid bodies where LIGGGHTS does not say it in the velocities of their nodes.
#ifndef LMP_PFV_MESH_MOTION_H
#define LMP_PFV_MESH_MOTION_H

#include "pfv/container.hpp"

#include "pointers.h"

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

struct PfvMeshMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at the pivot, m/s
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< 1/s
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< m
};

/// LIGGGHTS sets the node velocities of a mesh under move/mesh to 0 when a run begins, until its first step. Between
/// two runs the mesh goes on as in the last step, as long as the same commands move it.
class PfvMeshMotions : protected Pointers {
 public:
  explicit PfvMeshMotions(class LAMMPS* lmp) : Pointers(lmp) {}

  /// The motion of mesh `number`, read from its nodes as `found`: that of the last step, where none was made since.
  PfvMeshMotion present(std::size_t number, class FixMeshSurface* mesh, const PfvMeshMotion& found);

  /// For the restart file.
  std::vector<double> record() const;
  void restore(const std::vector<double>& record);

 private:
  struct Kept {
    double moved_for = 0.0;  ///< s, by all its move/mesh commands
    PfvMeshMotion motion;
  };
  double moved_for(class FixMeshSurface* mesh) const;

  std::vector<Kept> kept_;
};

/// Whether the mesh stays where it is and its surface moves: `surface_vel`, `surface_ang_vel`.
bool is_conveyor(class FixMeshSurface* mesh);
/// The motion of its surface in itself, at LIGGGHTS' speed; none where that of a rigid plane or cylinder would be another.
std::optional<PfvMeshMotion> conveyor_motion(class FixMeshSurface* mesh, const pfv::Surface& surface);

}  // namespace LAMMPS_NS

#endif
