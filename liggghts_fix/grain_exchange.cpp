// SPDX-License-Identifier: GPL-3.0-or-later
#include "grain_exchange.h"

#include "pfv/ranks.hpp"

#include "atom.h"
#include "comm.h"
#include "domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace LAMMPS_NS {

namespace {

constexpr int plain_width = 12;  // tag, place, velocity, radius, mass, spin
constexpr int loads_width = 7;   // force, torque, inertia
constexpr int periods_width = 3;

}  // namespace

void PfvGrainExchange::gather(const PfvGroups& groups, bool with_forces, const PfvStreaming& streaming,
                              const PfvHomes& homes) {
  groupbit_ = groups.flow;
  with_forces_ = with_forces;
  periodic_ = PfvPeriodicCell(lmp).any();
  std::vector<int> home;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit_) home.push_back(homes.is_known(i) ? homes.of(i) : comm->me);
  rows_.set_homes(std::move(home));
  received_ = rows_.to_homes(packed(groups, streaming), width());
  sort_by_tag();
  unpack();
}

std::vector<int> PfvGrainExchange::deal(const PfvHomes& homes, const pfv::Ranks& ranks, const Eigen::Matrix3Xd& others) {
  Eigen::Matrix3Xd places(3, grain_count() + others.cols());
  places << grains_.positions.leftCols(grain_count()), others;
  const std::vector<int> parts = pfv::parts_by_place(places, ranks);
  Eigen::MatrixXd values(1, grain_count());
  for (Eigen::Index k = 0; k < values.cols(); ++k) values(0, k) = 1.0 + parts[k];
  const std::vector<double> mine = at_atoms(values);
  std::size_t next = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit_) homes.per_atom[i][homes.column] = mine[next++];
  return {parts.begin() + grain_count(), parts.end()};
}

std::vector<double> PfvGrainExchange::at_atoms(const Eigen::MatrixXd& at_homes) const {
  std::vector<double> rows(static_cast<std::size_t>(at_homes.size()));
  for (Eigen::Index k = 0; k < at_homes.cols(); ++k)
    Eigen::Map<Eigen::VectorXd>(&rows[static_cast<std::size_t>(at_homes.rows()) * order_[k]], at_homes.rows()) = at_homes.col(k);
  return rows_.back(rows, static_cast<int>(at_homes.rows()));
}

Eigen::MatrixXd PfvGrainExchange::at_homes(const std::vector<double>& at_atoms, int width) const {
  const std::vector<double> rows = rows_.to_homes(at_atoms, width);
  Eigen::MatrixXd values(width, grain_count());
  for (Eigen::Index k = 0; k < values.cols(); ++k)
    values.col(k) = Eigen::Map<const Eigen::VectorXd>(&rows[std::size_t(width) * order_[k]], width);
  return values;
}

int PfvGrainExchange::width() const {
  return plain_width + (with_forces_ ? loads_width : 0) + (periodic_ ? periods_width : 0);
}

/// A row for each grain of this rank.
std::vector<double> PfvGrainExchange::packed(const PfvGroups& groups, const PfvStreaming& streaming) const {
  constexpr double immovable = std::numeric_limits<double>::infinity();
  const PfvPeriodicCell cell(lmp);
  std::vector<double> mine;
  for (int i = 0; i < atom->nlocal; ++i) {
    const int mask = atom->mask[i];
    if (!(mask & groupbit_)) continue;
    const double *x = atom->x[i], *v = atom->v[i], *spin = atom->omega[i];
    mine.insert(mine.end(), {static_cast<double>(atom->tag[i]), x[0], x[1], x[2], v[0], v[1], v[2], atom->radius[i],
                             groups.free(mask) ? atom->rmass[i] : immovable, spin[0], spin[1], spin[2]});
    if (mask & streaming.groupbit)
      for (int k = 0; k < 3; ++k)
        mine[mine.size() - plain_width + 4 + k] += streaming.drift[k] + streaming.rate[k] * (x[k] - streaming.origin[k]);
    if (with_forces_) {
      mine.insert(mine.end(), atom->f[i], atom->f[i] + 3);
      mine.insert(mine.end(), atom->torque[i], atom->torque[i] + 3);
      mine.push_back(groups.free_to_turn(mask)
                         ? 0.4 * atom->rmass[i] * atom->radius[i] * atom->radius[i]
                         : immovable);
    }
    if (!periodic_) continue;
    const Eigen::Vector3d periods = cell.periods(i);
    mine.insert(mine.end(), periods.begin(), periods.end());
  }
  return mine;
}

void PfvGrainExchange::sort_by_tag() {
  const int count = rows_.count();
  const auto by_tag = [this](int a, int b) {
    return received(a)[0] < received(b)[0];
  };
  // atoms change their places in LIGGGHTS' arrays seldom: the last order mostly still holds
  if (static_cast<int>(order_.size()) != count) {
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0);
  }
  if (!std::is_sorted(order_.begin(), order_.end(), by_tag))
    std::sort(order_.begin(), order_.end(), by_tag);
}

/// The arrays for the library, from what the ranks have sent.
void PfvGrainExchange::unpack() {
  const auto count = static_cast<int>(order_.size());
  grains_.ids.resize(count);
  grains_.positions.resize(3, count);
  grains_.velocities.resize(3, count);
  grains_.radii.resize(count);
  grains_.angular_velocities.resize(3, count);
  masses_.resize(count);
  grains_.displaced_volumes.resize(0);
  grains_.bodies.resize(0);
  forces_.resize(3, with_forces_ ? count : 0);
  torques_.resize(3, with_forces_ ? count : 0);
  inertias_.resize(with_forces_ ? count : 0);
  unwrapped_.resize(3, periodic_ ? count : 0);
  const Eigen::Map<const Eigen::Vector3d> lengths(domain->prd);
  for (int k = 0; k < count; ++k) {
    const double* row = received(order_[k]);
    grains_.ids[k] = static_cast<std::int64_t>(row[0]);
    grains_.positions.col(k) << row[1], row[2], row[3];
    grains_.velocities.col(k) << row[4], row[5], row[6];
    grains_.radii[k] = row[7];
    masses_[k] = row[8];
    grains_.angular_velocities.col(k) << row[9], row[10], row[11];
    if (periodic_)
      unwrapped_.col(k) = grains_.positions.col(k) +
                          Eigen::Map<const Eigen::Vector3d>(row + width() - periods_width).cwiseProduct(lengths);
    if (!with_forces_) continue;
    forces_.col(k) << row[12], row[13], row[14];
    torques_.col(k) << row[15], row[16], row[17];
    inertias_[k] = row[18];
  }
}

void PfvGrainExchange::add(const pfv::Obstacle& obstacle, const pfv::ObstaclePart& part, const pfv::ObstacleMotion& motion,
                           std::int64_t first_id, const pfv::Container& container) {
  pfv::add_obstacle(grains_, obstacle, part, motion, first_id, container);
  constexpr double immovable = std::numeric_limits<double>::infinity();
  const Eigen::Index before = masses_.size(), all = grains_.ids.size();
  masses_.conservativeResize(all);
  masses_.tail(all - before).setConstant(immovable);
  if (!with_forces_) return;
  forces_.conservativeResize(3, all);
  forces_.rightCols(all - before).setZero();
  torques_.conservativeResize(3, all);
  torques_.rightCols(all - before).setZero();
  inertias_.conservativeResize(all);
  inertias_.tail(all - before).setConstant(immovable);
}

pfv::Packing PfvGrainExchange::grains() const {
  const Eigen::Index count = grain_count();
  pfv::Packing packing;
  new (&packing.ids) decltype(packing.ids)(grains_.ids.data(), count);
  new (&packing.positions) decltype(packing.positions)(grains_.positions.data(), 3, count);
  new (&packing.radii) decltype(packing.radii)(grains_.radii.data(), count);
  return packing;
}

void PfvGrainExchange::use_mean_velocities(const PfvSnapshot& then, double elapsed, const Eigen::Vector3d& lengths) {
  std::size_t old = 0;
  for (Eigen::Index k = 0; k < grains_.ids.size(); ++k) {
    while (old < then.tags.size() && then.tags[old] < grains_.ids[k]) ++old;
    if (old == then.tags.size()) return;
    if (then.tags[old] != grains_.ids[k]) continue;
    const Eigen::Map<const Eigen::Vector3d> place(&then.places[3 * old]);
    Eigen::Vector3d moved = grains_.positions.col(k) - place;
    for (int axis = 0; axis < 3; ++axis)
      if (lengths[axis] > 0.0) moved[axis] -= lengths[axis] * std::round(moved[axis] / lengths[axis]);
    grains_.velocities.col(k) = moved / elapsed;
  }
}

Eigen::MatrixXd PfvSnapshot::columns(const pfv::Packing::Ids& ids) const {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(width, ids.size());
  std::size_t old = 0;
  for (Eigen::Index k = 0; k < ids.size(); ++k) {
    while (old < tags.size() && tags[old] < ids[k]) ++old;
    if (old < tags.size() && tags[old] == ids[k])
      values.col(k) << 1.0, places[3 * old], places[3 * old + 1], places[3 * old + 2];
  }
  return values;
}

PfvSnapshot PfvSnapshot::of_columns(const pfv::Packing::Ids& ids, const Eigen::MatrixXd& columns) {
  PfvSnapshot snapshot;
  for (Eigen::Index k = 0; k < ids.size(); ++k) {
    if (columns(0, k) == 0.0) continue;
    snapshot.tags.push_back(ids[k]);
    for (int axis = 0; axis < 3; ++axis) snapshot.places.push_back(columns(1 + axis, k));
  }
  return snapshot;
}

PfvSnapshot gathered(const PfvSnapshot& own, const PfvFlowRanks& ranks) {
  if (!ranks.are_all()) return own;
  std::vector<double> rows;
  for (std::size_t k = 0; k < own.tags.size(); ++k) {
    rows.push_back(static_cast<double>(own.tags[k]));
    rows.insert(rows.end(), &own.places[3 * k], &own.places[3 * k] + 3);
  }
  std::map<std::int64_t, std::array<double, 3>> by_tag;
  const std::vector<double> all = ranks.gathered(rows);
  for (std::size_t k = 0; k < all.size(); k += 4) by_tag[static_cast<std::int64_t>(all[k])] = {all[k + 1], all[k + 2], all[k + 3]};
  PfvSnapshot snapshot;
  for (const auto& [tag, place] : by_tag) {
    snapshot.tags.push_back(tag);
    snapshot.places.insert(snapshot.places.end(), place.begin(), place.end());
  }
  return snapshot;
}

PfvSnapshot PfvGrainExchange::snapshot() const {
  const auto& ids = grains_.ids;
  const auto& places = grains_.positions;
  return {{ids.data(), ids.data() + ids.size()}, {places.data(), places.data() + places.size()}};
}

void PfvGrainExchange::scatter(const pfv::Forces& forces, const pfv::HeldLoads* held,
                               double** per_atom, bool with_slopes) {
  const int width = with_slopes ? width_with_slopes : returned_width;
  const auto count = static_cast<Eigen::Index>(order_.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(width, count);
  if (count > 0) {
    all.topRows<3>() = forces.total.leftCols(count);
    all.row(3) = forces.sphere_pressure.head(count).transpose();
    if (forces.torque.cols() > 0) all.middleRows<3>(4) = forces.torque.leftCols(count);
    if (with_slopes && held && held->slope.cols() == forces.total.cols()) all.bottomRows<6>() = held->slope.leftCols(count);
  }
  const std::vector<double> mine = at_atoms(all);
  const double* row = mine.data();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (atom->mask[i] & groupbit_) {
      std::copy(row, row + width, per_atom[i]);
      row += width;
    } else {
      std::fill(per_atom[i], per_atom[i] + width, 0.0);
    }
  }
}

}  // namespace LAMMPS_NS
