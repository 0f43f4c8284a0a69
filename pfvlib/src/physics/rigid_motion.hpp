// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pfv {

/// How rigid things move, or what acts on them: a column for each sphere, then one for each face of the container.
/// Rows 0-2: velocity (m/s) or force (N). Rows 3-5: angular velocity (rad/s) or moment (N m): a sphere's
/// about its centre; a face's, and its velocity, about the network's origin (PoreNetwork::origin).
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Motion = Matrix6Xd;
using Loads = Matrix6Xd;

/// Zeros for so many spheres and faces.
inline Matrix6Xd no_motion(Eigen::Index spheres, Eigen::Index faces) {
  return Matrix6Xd::Zero(6, spheres + faces);
}

/// Motion of a face; the container's own corner may have moved on from `origin`.
inline Vector6d motion_of(const ContainerFace& face, const Eigen::Vector3d& origin) {
  Vector6d motion;
  motion.head<3>() = face.velocity + face.angular_velocity.cross(origin - face.pivot);
  motion.tail<3>() = face.angular_velocity;
  return motion;
}

/// Fills in the columns of the faces.
inline void set_faces(Motion& motion, const Container& container, const Eigen::Vector3d& origin) {
  const Eigen::Index spheres = motion.cols() - container.face_count();
  for (int f = 0; f < container.face_count(); ++f)
    motion.col(spheres + f) = motion_of(container.faces[f], origin);
}

}  // namespace pfv
