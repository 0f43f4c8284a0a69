// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"
#include "physics/force_matrix.hpp"
#include "physics/rigid_motion.hpp"
#include "pfv/flow_model.hpp"

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace pfv {

/// B of v = B w: how spheres go along with the rigid bodies that hold them, v_i = V + Omega x r_i. A *wide* motion or
/// load has, behind the columns of spheres and faces, one for each body: its velocity, or the force on it,
/// along x, y, z, and its spin, or the moment about its centre of mass, along its principal axes. There its mass
/// is diagonal. As B^T hands loads on where B hands motions, no power is lost between them. Of several ranks each has
/// all bodies, and as members its own spheres.
struct RigidBodies {
  struct Member {
    int sphere;  ///< column of a motion
    int body;    ///< number, from 0 on
    Eigen::Matrix3d lever;  ///< Omega x r of a spin along the principal axes
  };
  int first = 0;  ///< column of the first body
  std::vector<Eigen::Matrix3d> axes;  ///< principal, one a column
  std::vector<Member> members;        ///< by sphere, ascending
  std::shared_ptr<const Ranks> ranks; ///< that have spheres of them; null: this one has all

  int count() const { return static_cast<int>(axes.size()); }
  /// What the load on a sphere is on its body.
  Vector6d on_body(const Member& member, const Vector6d& load) const;
  /// How a sphere moves with its body.
  Vector6d of_sphere(const Member& member, const Vector6d& motion) const;
  /// B^T: loads with those on the bodies behind them. Collective.
  Loads gathered(const Loads& loads) const;
  /// B: a wide motion with that of the bodies added to their spheres.
  Motion spread(const Motion& wide) const;
};

/// `held`: of each sphere of the packing its body or -1; `columns`: of the packing, of each sphere that takes part.
RigidBodies rigid_bodies(const Eigen::Ref<const Eigen::VectorXi>& held, const std::vector<int>& columns, int faces,
                         const std::vector<RigidBody>& bodies);

/// B^T S: a row for each body behind the others, and none of the spheres that they hold.
ForceMatrix forces_on_bodies(const ForceMatrix& forces, const RigidBodies& bodies);

}  // namespace pfv
