// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.h"

#include "periodic_cell.h"

#include "pfv/union_parts.hpp"

#include "comm.h"

#include <mpi.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
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
void PfvBodies::add(const PfvBodyKey& key, const PfvBody& body, const Held& held, const Eigen::Vector3d& gravity) {
  pfv::RigidBody rigid;
  const PfvPeriodicCell cell(lmp);
  rigid.arms.resize(3, static_cast<Eigen::Index>(held.members.size()));
  for (std::size_t i = 0; i < held.members.size(); ++i)
    rigid.arms.col(static_cast<Eigen::Index>(i)) = cell.image_near(held.members[i]->place, body.centre) - body.centre;
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
void PfvBodies::add_loads_from_outside(const PfvBodyList& list, const std::map<PfvBodyKey, int>& places) {
  const PfvPeriodicCell cell(lmp);
  for (const PfvMember& member : list.members) {
    if (member.in_flow) continue;
    pfv::RigidBody& body = rigid_[places.at(member.body)];
    const Eigen::Vector3d& centre = list.bodies.at(member.body).centre;
    body.other_force += member.force;
    body.other_torque += (cell.image_near(member.place, centre) - centre).cross(member.force) + member.torque;
  }
}

/// Bodies that this rank looks at, numbered from `first` on, and what is told of them to the homes of their grains.
void PfvBodies::look_at(const PfvBodyList& list, const Eigen::Vector3d& gravity, int first, std::vector<OfGrain>& told,
                        std::vector<int>& homes) {
  std::map<PfvBodyKey, Held> held;
  for (const PfvMember& member : list.members) {
    if (!member.in_flow) continue;
    held[member.body].members.push_back(&member);
    held[member.body].free |= member.free;
  }
  std::map<PfvBodyKey, int> places;
  std::map<PfvBodyKey, Volumes> still;
  for (const auto& [key, own] : held) {
    const PfvBody& body = list.bodies.at(key);
    places[key] = static_cast<int>(rigid_.size());
    add(key, body, own, gravity);
    const double mass = standing_mass(rigid_.back());
    const Eigen::VectorXd volumes = volumes_of(key, body, own);
    still[key] = known_[key];
    for (std::size_t i = 0; i < own.members.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const auto arm = rigid_.back().arms.col(k);
      told.push_back({static_cast<double>(own.members[i]->tag), static_cast<double>(first + places[key]), mass, volumes[k],
                      {arm[0], arm[1], arm[2]}});
      homes.push_back(own.members[i]->home);
    }
  }
  add_loads_from_outside(list, places);
  known_ = std::move(still);
}

void PfvBodies::apply(const PfvGroups& groups, const Eigen::Vector3d& gravity, const PfvHomes& homes,
                      const PfvFlowRanks& ranks, PfvGrainExchange& grains) {
  rigid_.clear();
  obstacle_.clear();
  const PfvBodySources sources(lmp);
  if (!sources.any()) return;
  const PfvBodyList list = sources.gather(groups, homes);
  int own = static_cast<int>(list.bodies.size()), first = 0;
  MPI_Exscan(&own, &first, 1, MPI_INT, MPI_SUM, world);
  if (comm->me == 0) first = 0;
  std::vector<OfGrain> told;
  std::vector<int> homes_of_grains;
  look_at(list, gravity, first, told, homes_of_grains);
  if (ranks.are_all()) share_bodies(ranks);
  tell(told, std::move(homes_of_grains), grains);
}

/// A rigid body keeps them: found once, and when a sphere of it comes, goes or grows.
Eigen::VectorXd PfvBodies::volumes_of(const PfvBodyKey& key, const PfvBody& body, const Held& held) {
  Volumes now;
  now.radii.resize(static_cast<Eigen::Index>(held.members.size()));
  for (std::size_t i = 0; i < held.members.size(); ++i) {
    now.radii[static_cast<Eigen::Index>(i)] = held.members[i]->radius;
    now.tags.push_back(held.members[i]->tag);
  }
  const auto known = known_.find(key);
  if (known != known_.end() && known->second.tags == now.tags && known->second.radii == now.radii)
    return known->second.volumes;
  const Eigen::Matrix3Xd centres = rigid_.back().arms.colwise() + body.centre;
  const bool whole = static_cast<double>(held.members.size()) == body.spheres;
  now.volumes = whole ? pfv::displaced_volumes(centres, now.radii, body.centre)
                      : pfv::union_parts(centres, now.radii);
  return (known_[key] = now).volumes;
}

/// All ranks have those of each, and the reason of the lowest one that has any.
void PfvBodies::share_bodies(const PfvFlowRanks& ranks) {
  constexpr int width = 21;
  std::vector<double> rows;
  for (const pfv::RigidBody& body : rigid_) {
    rows.insert(rows.end(), body.masses.begin(), body.masses.end());
    rows.insert(rows.end(), body.inertias.begin(), body.inertias.end());
    rows.insert(rows.end(), body.axes.data(), body.axes.data() + 9);
    rows.insert(rows.end(), body.other_force.begin(), body.other_force.end());
    rows.insert(rows.end(), body.other_torque.begin(), body.other_torque.end());
  }
  const std::vector<double> all = ranks.everywhere(rows);
  rigid_.assign(all.size() / width, {});
  using Three = Eigen::Map<const Eigen::Vector3d>;
  for (std::size_t b = 0; b < rigid_.size(); ++b) {
    const double* const row = &all[width * b];
    rigid_[b].masses = Three(row);
    rigid_[b].inertias = Three(row + 3);
    rigid_[b].axes = Eigen::Map<const Eigen::Matrix3d>(row + 6);
    rigid_[b].other_force = Three(row + 15);
    rigid_[b].other_torque = Three(row + 18);
  }
  std::vector<double> letters(obstacle_.begin(), obstacle_.end());
  if (!letters.empty()) letters.push_back(0.0);
  obstacle_.clear();
  for (const double letter : ranks.everywhere(letters)) {
    if (letter == 0.0) break;
    obstacle_ += static_cast<char>(letter);
  }
}

/// The homes of grains learn what these count for.
void PfvBodies::tell(const std::vector<OfGrain>& told, std::vector<int> homes, PfvGrainExchange& grains) {
  constexpr int width = sizeof(OfGrain) / sizeof(double);
  std::vector<double> rows(width * told.size());
  if (!told.empty()) std::memcpy(rows.data(), told.data(), rows.size() * sizeof(double));
  PfvRankRows routes(lmp);
  routes.set_homes(std::move(homes));
  rows = routes.to_homes(rows, width);
  std::vector<OfGrain> here(rows.size() / width);
  if (!rows.empty()) std::memcpy(here.data(), rows.data(), rows.size() * sizeof(double));
  if (rigid_.empty()) return;
  std::sort(here.begin(), here.end(), [](const OfGrain& a, const OfGrain& b) { return a.tag < b.tag; });

  const pfv::Packing packing = grains.packing();
  Eigen::VectorXi of_sphere = Eigen::VectorXi::Constant(packing.size(), -1);
  Eigen::VectorXd masses = grains.masses();
  Eigen::VectorXd volumes = 4.0 / 3.0 * M_PI * packing.radii.array().cube();
  std::vector<std::vector<double>> arms(rigid_.size());
  for (const OfGrain& one : here) {
    const auto tag = static_cast<std::int64_t>(one.tag);
    const auto* const place = std::lower_bound(packing.ids.data(), packing.ids.data() + packing.size(), tag);
    const auto column = place - packing.ids.data();
    of_sphere[column] = static_cast<int>(one.number);
    masses[column] = one.mass;
    volumes[column] = one.volume;
    arms[of_sphere[column]].insert(arms[of_sphere[column]].end(), one.arm, one.arm + 3);
  }
  for (std::size_t b = 0; b < rigid_.size(); ++b)
    rigid_[b].arms = Eigen::Map<const Eigen::Matrix3Xd>(arms[b].data(), 3, static_cast<Eigen::Index>(arms[b].size() / 3));
  grains.stand_for_bodies(masses, volumes, of_sphere);
}

}  // namespace LAMMPS_NS
