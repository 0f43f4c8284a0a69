// SPDX-License-Identifier: GPL-3.0-or-later
// Where the faces of the flow box or container are and how fast they move: planes, walls, meshes, grains.
#ifndef LMP_PFV_FACE_SOURCES_H
#define LMP_PFV_FACE_SOURCES_H

#include "arguments.h"
#include "flow_ranks.h"
#include "mesh_motion.h"

#include "pfv/flow_model.hpp"
#include "pfv/mesh_walls.hpp"

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Of a servo that controls a force along the face's axis: velocity (m/s) it answers 1 N with, and the
/// setting that this follows from; 0 without such a servo.
struct PfvServoGain {
  double gain = 0.0;
  double kp = 0.0;
};

class PfvFaceSources : protected Pointers {
 public:
  explicit PfvFaceSources(class LAMMPS* lmp) : Pointers(lmp), motions_(lmp) {}

  /// Finds the walls and meshes that the faces name. Throws pfv::InputError, the same on all ranks,
  /// where one is missing or has not the shape that its face needs: of a box, a plane normal to the face's axis.
  void bind(const PfvSettings& settings);

  /// Reads where planes, walls and meshes are now; collective. Leaves `extent` faces alone. Throws
  /// pfv::InputError, the same on all ranks, for a mesh that is no longer normal to its axis.
  void read();

  /// Whether the face's mesh stays and only its surface moves.
  bool is_conveyor(int number) const { return LAMMPS_NS::is_conveyor(meshes_[number]); }
  /// A line for each face that cannot have the motion of its mesh's surface, and is at rest.
  std::vector<std::string> surfaces_at_rest() const;
  /// How meshes move, kept from run to run.
  PfvMeshMotions& motions() { return motions_; }

  /// Whether `follow_grains` has anything to do.
  bool wants_grains() const;
  /// Puts `extent` faces at the extremes of the grains, where the flow is; at the simulation box's sides until there are
  /// any.
  void follow_grains(const PfvGrainTotals& grains);
  /// For messages: where the `extent` faces are and what to do where they are beyond others; empty without any.
  std::string followers() const;
  /// Throws pfv::InputError where two faces of a box leave no room; after `follow_grains`.
  void require_room() const;

  /// m; of a container's faces a number that changes with their place.
  const std::vector<double>& positions() const { return positions_; }
  /// Places that move with the faces of a container: m.
  std::vector<Eigen::Vector3d> pivots() const;
  /// Of a container's face: how it moves, and its shape with the fluid inside; the latter after `follow_grains`.
  void set_motion(int number, pfv::ContainerFace& face) const;
  pfv::Surface surface(int number) const;
  /// Area of the mesh that each face of a container follows, m²; 0 for others. Collective.
  std::vector<double> mesh_areas() const;
  /// A container's face in words: its name, source, shape, and how far a mesh strays from it.
  std::string described(int number) const;
  /// A box's face with its motion in its own plane, which a mesh's nodes have as parts of one rigid body.
  pfv::FaceCondition condition(int number, pfv::Wall wall, pfv::Boundary boundary) const;

  /// Remembers what the meshes' stress modules hold before the forces of a step are reckoned.
  void begin_forces();

  /// The faces that are pistons: meshes under a servo whose only gain is that of the integral and that
  /// controls a force along the face's axis. LIGGGHTS moves them by m dv/dt = F + target with
  /// m = target / (vel_max ki). With `forces`: also the force of the grains on them in this step and the
  /// target; collective.
  void read_pistons(bool forces);
  const std::vector<pfv::Piston>& pistons() const { return pistons_; }

  /// The faces under a servo with a proportional gain: v = kp vel_max (target - F) / target.
  std::vector<PfvServoGain> proportional_gains() const;

  bool any_mesh() const;
  /// Each mesh once, without those under a servo, whose motion follows from loads.
  std::vector<class FixMeshSurface*> prescribed_meshes() const;
  /// The largest force that grains put on one of the meshes along its axis in this step, N; collective.
  double largest_load() const;
  /// Adds a force (N) to what the meshes' stress modules record in this step, so that outputs and
  /// servos see it. Rank 0.
  void push_meshes(const std::vector<Eigen::Vector3d>& forces) const;

 private:
  int count() const { return static_cast<int>(sources_.size()); }
  int axis_of(int number) const;  ///< that the face is normal to and may be moved along, or -1
  [[noreturn]] void fail(int number, const std::string& what) const;
  class Fix* find_fix(int number, const std::string& id) const;
  void bind_wall(const PfvFaceSource& source, int number);
  void bind_mesh(const PfvFaceSource& source, int number);
  void bind_part(const PfvFaceSource& source, int number);
  void read_plane(int number);
  void read_end_of_period(int number);
  pfv::Surface along_periods(pfv::Surface surface) const;
  void read_parts();
  void read_motion_of_part(int number);
  void read_mesh(int number);
  void read_gliding(int number);
  void settle_motion(int number);
  PfvMeshMotion motion(int number) const;
  void set_motion(int number, const PfvMeshMotion& motion);
  pfv::Surface present_surface(int number) const;
  void turn_outwards(const Eigen::Vector3d& middle);
  double way_out(int number, const Eigen::Vector3d& inside) const;  ///< 1 or -1 for a shape's normal
  std::vector<Eigen::Vector3d> outward_normals() const;             ///< of a container; 0 where unknown

  PfvMeshMotions motions_;
  bool container_ = false;
  std::vector<std::string> names_;
  std::vector<PfvFaceSource> sources_;
  std::vector<class FixMeshSurface*> meshes_;
  std::vector<double> begun_;  ///< force along the face's axis that this rank's module held, N
  std::vector<double> positions_;
  std::vector<double> velocities_;
  std::vector<pfv::Piston> pistons_;
  struct Gliding {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), pivot = Eigen::Vector3d::Zero();
    double spin = 0.0;
  };
  std::vector<Gliding> gliding_;
  std::vector<pfv::ContainerFace> shapes_;  ///< of a container
  std::vector<pfv::MeshWall> parts_;        ///< the walls of meshes that have several or are round
  bool read_since_bound_ = false;
  std::vector<Eigen::Vector3d> normals_before_;  ///< that pointed outwards when the walls were last bound; 0: unknown
  std::vector<double> outwards_;            ///< which way a shape's normal points: 1, -1, or 0 as long as unknown
};

}  // namespace LAMMPS_NS

#endif
