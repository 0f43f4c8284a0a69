// SPDX-License-Identifier: GPL-3.0-or-later
// Where the six faces of the flow box are and how fast they move: planes, walls, meshes, grains.
#ifndef LMP_PFV_FACE_SOURCES_H
#define LMP_PFV_FACE_SOURCES_H

#include "arguments.h"

#include "pfv/flow_model.hpp"

#include "pointers.h"

#include <array>

namespace LAMMPS_NS {

/// Of a servo that controls a force along the face's axis: velocity (m/s) it answers 1 N with, and the
/// setting that this follows from; 0 without such a servo.
struct PfvServoGain {
  double gain = 0.0;
  double kp = 0.0;
};

class PfvFaceSources : protected Pointers {
 public:
  explicit PfvFaceSources(class LAMMPS* lmp) : Pointers(lmp) {}

  /// Finds the walls and meshes that the faces name. Throws pfv::InputError, the same on all ranks,
  /// where one is missing or is no plane normal to the face's axis.
  void bind(const std::array<PfvFaceSource, 6>& sources);

  /// Reads where planes, walls and meshes are now; collective. Leaves `extent` faces alone. Throws
  /// pfv::InputError, the same on all ranks, for a mesh that is no longer normal to its axis.
  void read();

  /// Puts `extent` faces at the extremes of the grains; rank 0. Throws pfv::InputError when there
  /// are none.
  void follow_grains(const Eigen::Ref<const Eigen::Matrix3Xd>& centres,
                     const Eigen::Ref<const Eigen::VectorXd>& radii);

  const std::array<double, 6>& positions() const { return positions_; }    ///< m
  /// m/s along the face's axis; that of a mesh's nodes, 0 for everything else.
  const std::array<double, 6>& velocities() const { return velocities_; }
  /// The face with its motion in its own plane, which a mesh's nodes have as parts of one rigid body.
  pfv::FaceCondition condition(int number, pfv::Wall wall, pfv::Boundary boundary) const;

  /// Remembers what the meshes' stress modules hold before the forces of a step are reckoned.
  void begin_forces();

  /// The faces that are pistons: meshes under a servo whose only gain is that of the integral and that
  /// controls a force along the face's axis. LIGGGHTS moves them by m dv/dt = F + target with
  /// m = target / (vel_max ki). With `forces`: also the force of the grains on them in this step and the
  /// target; collective.
  std::array<pfv::Piston, 6> pistons(bool forces) const;

  /// The faces under a servo with a proportional gain: v = kp vel_max (target - F) / target.
  std::array<PfvServoGain, 6> proportional_gains() const;

  bool any_mesh() const;
  /// The largest force that grains put on one of the meshes along its axis in this step, N; collective.
  double largest_load() const;
  /// Adds a force (N) to what the meshes' stress modules record in this step, so that outputs and
  /// servos see it. Rank 0.
  void push_meshes(const std::array<Eigen::Vector3d, 6>& forces) const;

 private:
  void bind_wall(const PfvFaceSource& source, int number);
  void bind_mesh(const PfvFaceSource& source, int number);
  void read_mesh(int number);
  void read_gliding(int number);

  std::array<PfvFaceSource, 6> sources_;
  std::array<class FixMeshSurface*, 6> meshes_{};
  std::array<double, 6> begun_{};  ///< force along the face's axis that this rank's module held, N
  std::array<double, 6> positions_{};
  std::array<double, 6> velocities_{};
  struct Gliding {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), pivot = Eigen::Vector3d::Zero();
    double spin = 0.0;
  };
  std::array<Gliding, 6> gliding_{};
};

}  // namespace LAMMPS_NS

#endif
