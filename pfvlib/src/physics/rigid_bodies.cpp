// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/rigid_bodies.hpp"

#include <algorithm>
#include <map>

namespace pfv {

Vector6d RigidBodies::on_body(const Member& member, const Vector6d& load) const {
  Vector6d result;
  result.head<3>() = load.head<3>();
  result.tail<3>() =
      member.lever.transpose() * load.head<3>() + axes[member.body].transpose() * load.tail<3>();
  return result;
}

Vector6d RigidBodies::of_sphere(const Member& member, const Vector6d& motion) const {
  Vector6d result;
  result.head<3>() = motion.head<3>() + member.lever * motion.tail<3>();
  result.tail<3>() = axes[member.body] * motion.tail<3>();
  return result;
}

Loads RigidBodies::gathered(const Loads& loads) const {
  Loads wide(6, first + count());
  wide << loads, Loads::Zero(6, count());
  for (const Member& member : members)
    wide.col(first + member.body) += on_body(member, loads.col(member.sphere));
  if (ranks && count() > 0) ranks->add(wide.col(first).data(), static_cast<std::size_t>(6 * count()));
  return wide;
}

Motion RigidBodies::spread(const Motion& wide) const {
  Motion motion = wide.leftCols(first);
  for (const Member& member : members)
    motion.col(member.sphere) += of_sphere(member, wide.col(first + member.body));
  return motion;
}

namespace {

Eigen::Matrix3d lever_of(const Eigen::Vector3d& arm, const Eigen::Matrix3d& axes) {
  Eigen::Matrix3d lever;
  for (int axis = 0; axis < 3; ++axis) lever.col(axis) = axes.col(axis).cross(arm);
  return lever;
}

}  // namespace

RigidBodies rigid_bodies(const Eigen::Ref<const Eigen::VectorXi>& held, const std::vector<int>& columns, int faces,
                         const std::vector<RigidBody>& bodies) {
  RigidBodies result;
  result.first = static_cast<int>(columns.size()) + faces;
  for (const RigidBody& body : bodies) result.axes.push_back(body.axes);
  std::vector<Eigen::Index> seen(bodies.size(), 0);
  std::size_t next = 0;
  for (int k = 0; k < held.size(); ++k) {
    const int own = static_cast<int>(next);
    const bool active = next < columns.size() && columns[next] == k;
    next += active;
    if (held[k] < 0) continue;
    const Eigen::Index place = seen[held[k]]++;
    if (active)
      result.members.push_back({own, held[k], lever_of(bodies[held[k]].arms.col(place), bodies[held[k]].axes)});
  }
  return result;
}

ForceMatrix forces_on_bodies(const ForceMatrix& forces, const RigidBodies& bodies) {
  ForceMatrix result;
  result.spheres = forces.spheres;
  result.bodies = bodies.count();
  std::vector<std::map<int, Vector6d>> of_body(bodies.count());
  std::vector<char> held(forces.rows(), 0);
  std::vector<Vector6d> values;
  for (const auto& member : bodies.members) {
    held[member.sphere] = 1;
    for (int e = forces.row_begin[member.sphere]; e < forces.row_begin[member.sphere + 1]; ++e)
      of_body[member.body].try_emplace(forces.pore[e], Vector6d::Zero()).first->second +=
          bodies.on_body(member, forces.value.col(e));
  }
  const auto add = [&](int pore, const Vector6d& value) {
    result.pore.push_back(pore);
    values.push_back(value);
  };
  const auto end_row = [&] { result.row_begin.push_back(static_cast<int>(result.pore.size())); };
  for (int row = 0; row < forces.rows(); ++row) {
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1] && !held[row]; ++e)
      add(forces.pore[e], forces.value.col(e));
    end_row();
  }
  for (const auto& row : of_body) {
    for (const auto& [pore, value] : row) add(pore, value);
    end_row();
  }
  result.value.resize(6, static_cast<Eigen::Index>(values.size()));
  for (std::size_t e = 0; e < values.size(); ++e) result.value.col(static_cast<Eigen::Index>(e)) = values[e];
  return result;
}

}  // namespace pfv
