// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pfv {

/// How rigid things move, or what acts on them: a column for each sphere, then one for each face of the box.
/// Rows 0-2: velocity (m/s) or force (N). Rows 3-5: angular velocity (rad/s) or moment (N m): a sphere's
/// about its centre; a face's, and its velocity, about the corner of the box (PoreNetwork::origin).
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Motion = Matrix6Xd;
using Loads = Matrix6Xd;

inline Eigen::Index spheres_in(const Motion& motion) { return motion.cols() - face_count; }
/// Zeros for so many spheres and the faces.
inline Matrix6Xd no_motion(Eigen::Index spheres) { return Matrix6Xd::Zero(6, spheres + face_count); }

/// Motion of a face of `box`; the box's own corner may have moved on from `origin`.
inline Vector6d motion_of(const FaceCondition& face, int axis, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d spin = face.spin * normal;
  Vector6d motion;
  motion.head<3>() = face.velocity * normal + face.sliding + spin.cross(origin - face.pivot);
  motion.tail<3>() = spin;
  return motion;
}

/// Fills in the columns of the faces.
inline void set_faces(Motion& motion, const Box& box, const Eigen::Vector3d& origin) {
  for (const Face face : all_faces)
    motion.col(spheres_in(motion) + static_cast<int>(face)) =
        motion_of(box[face], axis_of(face), origin);
}

}  // namespace pfv
