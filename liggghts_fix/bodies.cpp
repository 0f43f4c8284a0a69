// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.h"

#include "periodic_cell.h"

#include "pfv/union_parts.hpp"

#include "comm.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace LAMMPS_NS {

namespace {

constexpr double immovable = std::numeric_limits<double>::infinity();

/// How a force on the sphere at `arm` (m) from the centre of mass moves that sphere itself, 1/kg:
/// I/M + [r] J^-1 [r]^T, its largest eigenvalue.
double mobility(const pfv::RigidBody& body, const Eigen::Vector3d& arm) {
  Eigen::Matrix3d lever;
  for (int axis = 0; axis < 3; ++axis) lever.col(axis) = body.axes.col(axis).cross(arm);
  Eigen::Matrix3d moved = lever * body.inertias.cwiseInverse().asDiagonal() * lever.transpose();
  moved += body.masses.cwiseInverse().asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moved, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

/// kg: where every sphere of the body had this mass, and were on its own, the fluid would shake them sooner than
/// it does the body. A force on sphere j moves sphere i of the body by K_ij, and x.K x <= sum_j |K_jj| sum_i
/// |x_i|^2 for the forces x on its spheres: so 1 / sum_j |K_jj|, which for translation alone is the body's mass
/// over the number of its spheres.
double standing_mass(const pfv::RigidBody& body) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < body.arms.cols(); ++i) sum += mobility(body, body.arms.col(i));
  return 1.0 / sum;
}

std::string text_of(const PfvBodyKey& key) { return std::to_string(key.second); }

}  // namespace

/// A body with only some of its torques switched on turns by no inertia of its own.
void PfvBodies::add(const PfvBodyKey& key, const PfvBody& body, const Held& held, const Eigen::Vector3d& gravity,
                    const pfv::Packing& packing) {
  pfv::RigidBody rigid;
  const PfvPeriodicCell cell(lmp);
  rigid.arms.resize(3, static_cast<Eigen::Index>(held.columns.size()));
  for (std::size_t i = 0; i < held.columns.size(); ++i)
    rigid.arms.col(static_cast<Eigen::Index>(i)) =
        cell.image_near(packing.positions.col(held.columns[i]), body.centre) - body.centre;
  const bool turns = held.free && body.turns.maxCoeff() > 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    rigid.masses[axis] = held.free && body.moves[axis] > 0.0 ? body.mass : immovable;
    rigid.inertias[axis] = turns && body.inertia[axis] > 0.0 ? body.inertia[axis] : immovable;
  }
  rigid.axes = body.axes;
  if (body.weighed) rigid.other_force = body.mass * gravity;
  if (turns && body.turns.minCoeff() == 0.0)
    obstacle_ = "rigid body " + text_of(key) + " is turned by some components of its torque alone, which staged and "
                "implicit coupling cannot follow; switch all of them on or off, or use `coupling explicit`";
  rigid_.push_back(std::move(rigid));
}

/// Of spheres that are no grains of the flow.
void PfvBodies::add_loads_from_outside(const PfvBodyList& list, const std::map<PfvBodyKey, int>& numbers) {
  const PfvPeriodicCell cell(lmp);
  for (const PfvMember& member : list.members) {
    if (member.in_flow) continue;
    pfv::RigidBody& body = rigid_[numbers.at(member.body)];
    const Eigen::Vector3d& centre = list.bodies.at(member.body).centre;
    body.other_force += member.force;
    body.other_torque += (cell.image_near(member.place, centre) - centre).cross(member.force) + member.torque;
  }
}

void PfvBodies::apply(const PfvGroups& groups, const Eigen::Vector3d& gravity, PfvGrainExchange& grains) {
  rigid_.clear();
  obstacle_.clear();
  const PfvBodySources sources(lmp);
  if (!sources.any()) return;
  const PfvBodyList list = sources.gather(groups);
  if (comm->me != 0 || list.bodies.empty()) return;

  const pfv::Packing packing = grains.packing();
  std::map<PfvBodyKey, Held> held;
  for (const PfvMember& member : list.members) {
    if (!member.in_flow) continue;
    const auto* const place =
        std::lower_bound(packing.ids.data(), packing.ids.data() + packing.size(), member.tag);
    Held& own = held[member.body];
    own.columns.push_back(static_cast<int>(place - packing.ids.data()));
    own.free |= member.free;
  }
  std::map<PfvBodyKey, int> numbers;
  std::map<PfvBodyKey, Volumes> still;
  Eigen::VectorXi of_sphere = Eigen::VectorXi::Constant(packing.size(), -1);
  Eigen::VectorXd masses = grains.masses();
  Eigen::VectorXd volumes = 4.0 / 3.0 * M_PI * packing.radii.array().cube();
  for (const auto& [key, own] : held) {
    const PfvBody& body = list.bodies.at(key);
    numbers[key] = static_cast<int>(rigid_.size());
    of_sphere(own.columns).setConstant(numbers[key]);
    add(key, body, own, gravity, packing);
    masses(own.columns).setConstant(standing_mass(rigid_.back()));
    volumes(own.columns) = volumes_of(key, body, own, packing);
    still[key] = known_[key];
  }
  add_loads_from_outside(list, numbers);
  known_ = std::move(still);
  grains.stand_for_bodies(masses, volumes, of_sphere);
}

/// A rigid body keeps them: found once, and when a sphere of it comes, goes or grows.
Eigen::VectorXd PfvBodies::volumes_of(const PfvBodyKey& key, const PfvBody& body, const Held& held,
                                      const pfv::Packing& packing) {
  Volumes now;
  now.radii = packing.radii(held.columns);
  for (const int k : held.columns) now.tags.push_back(packing.ids[k]);
  const auto known = known_.find(key);
  if (known != known_.end() && known->second.tags == now.tags && known->second.radii == now.radii)
    return known->second.volumes;
  const Eigen::Matrix3Xd centres = rigid_.back().arms.colwise() + body.centre;
  const bool whole = static_cast<double>(held.columns.size()) == body.spheres;
  now.volumes = whole ? pfv::displaced_volumes(centres, now.radii, body.centre)
                      : pfv::union_parts(centres, now.radii);
  return (known_[key] = now).volumes;
}

}  // namespace LAMMPS_NS
