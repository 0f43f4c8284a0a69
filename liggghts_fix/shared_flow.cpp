// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: which ranks hold the flow, and which grains each of them has in it.
#include "fix_pfv.h"

#include "pfv/error.hpp"
#include "pfv/ranks.hpp"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_property_atom.h"

#include <mpi.h>
#include <algorithm>
#include <chrono>
#include <thread>

namespace LAMMPS_NS {

/// What of this scene several ranks cannot do together yet; empty where there is nothing.
std::string FixPfv::needs_one_rank() const {
  const pfv::Options& options = settings_.options;
  if (settings_.model != pfv::Model::pores) return "model darcy_grid";
  if (settings_.steps.coupling == pfv::Coupling::implicit) return "coupling implicit";
  if (options.volume_rates == pfv::VolumeRates::geometric) return "volume_rates geometric";
  for (const pfv::SolverAbilities& solver : pfv::Names<pfv::SolverKind>::all)
    if (solver.value == options.solver && solver.value != pfv::SolverKind::automatic && !solver.shared_by_ranks)
      return std::string("solver ") + solver.name;
  return {};
}

/// Once, when the first run begins: the flow does not move from one rank to all.
void FixPfv::choose_ranks() {
  const bool several = comm->nprocs > 1;
  const pfv::FlowRanks wanted = settings_.steps.ranks;
  const bool asked = wanted == pfv::FlowRanks::all ||
                     (wanted == pfv::FlowRanks::automatic && settings_.options.solver == pfv::SolverKind::amg);
  const std::string reason = needs_one_rank();
  if (several && !reason.empty() && (ranks_.are_all() || (!ranks_.dealt.chosen && wanted == pfv::FlowRanks::all)))
    stop(FLERR, reason + " needs the flow on one rank; leave it out, or give `ranks one`");
  if (ranks_.dealt.chosen) return;
  ranks_.dealt.chosen = true;
  if (!several || !asked) return;
  const std::string beginning = "Fix pfv (id " + std::string(id) + "): the flow is ";
  if (!reason.empty()) return print(beginning + "on one rank: " + reason + " needs that\n");
  print(beginning + "shared by " + std::to_string(comm->nprocs) + " ranks\n");
  ranks_.share();
  schedule_.share_among(ranks_.library());
}

PfvHomes FixPfv::homes() const {
  if (!ranks_.are_all()) return {};
  return {per_atom_->array_atom, ranks_.dealt.column};
}

/// How far the parts reach, m3: the boxes around the spheres of each rank, within the container, added up.
double FixPfv::spread() const {
  const pfv::Packing packing = grains_.grains();
  const Eigen::Matrix3Xd spheres = obstacles_.own_spheres();
  if (grains_.grain_count() + spheres.cols() == 0) return ranks_.sum(0.0);
  Eigen::Matrix3Xd places(3, packing.size() + spheres.cols());
  places << packing.positions, spheres;
  if (container_.face_count() > 0)
    for (int axis = 0; axis < 3; ++axis)
      places.row(axis) = places.row(axis).cwiseMax(container_.lower[axis]).cwiseMin(container_.upper[axis]);
  const double diameter = packing.size() > 0 ? 2.0 * packing.radii.maxCoeff() : 0.0;
  const Eigen::Vector3d reach = places.rowwise().maxCoeff() - places.rowwise().minCoeff();
  return ranks_.sum((reach.array() + diameter).prod());
}

/// Where grains have come that have no home yet, or have strayed so far that the parts overlap. The latter is looked at
/// where the pores have strained so far that the next call makes a new network, which is then that of the new parts, and
/// where there is one for another reason: then it costs another one. Collective, after the grains have been gathered.
void FixPfv::deal_where_due() {
  constexpr double strayed = 1.3;
  if (!ranks_.are_all()) return;
  const PfvHomes known = homes();
  bool homeless = ranks_.dealt.wanted || obstacles_.are_undealt();
  for (int i = 0; i < atom->nlocal && !homeless; ++i) homeless = (atom->mask[i] & groupbit) && !known.is_known(i);
  const bool is_due = flow_ && flow_->strain() >= settings_.options.retriangulation_strain;
  const std::int64_t network = (flow_ ? flow_->retriangulations() : 0) + (is_due ? 1 : 0);
  const bool is_new = network != ranks_.dealt.network;
  ranks_.dealt.network = network;
  if (ranks_.any(homeless) || (is_new && spread() > strayed * ranks_.dealt.spread)) deal_anew();
}

/// Each grain to the part that it is in now, and what is remembered of it.
void FixPfv::deal_anew() {
  const std::vector<double> places = grains_.at_atoms(since_.grains.columns(grains_.packing().ids));
  const Eigen::MatrixXd memory = schedule_.memory_of_grains(grains_.packing().ids);
  const std::vector<double> first_places = grains_.at_atoms(files_->first_places().columns(grains_.packing().ids));
  const bool remembers = memory.rows() > 0;
  const std::vector<double> loads = remembers ? grains_.at_atoms(memory) : std::vector<double>{};
  deal_obstacles(grains_.deal(homes(), *ranks_.library(), spheres_to_deal()));
  grains_.gather(others_.groups, needs_forces(), {}, homes());
  const pfv::Packing::Ids ids = grains_.packing().ids;
  since_.grains = PfvSnapshot::of_columns(ids, grains_.at_homes(places, PfvSnapshot::width));
  files_->set_first_places(PfvSnapshot::of_columns(ids, grains_.at_homes(first_places, PfvSnapshot::width)));
  if (remembers) schedule_.remember_grains(ids, grains_.at_homes(loads, static_cast<int>(memory.rows())));
  ranks_.dealt.wanted = false;
  ++ranks_.dealt.times;
  ranks_.dealt.spread = spread();
}

/// Each rank tells of some of the obstacles' spheres, which all know.
Eigen::Matrix3Xd FixPfv::spheres_to_deal() const {
  const Eigen::Matrix3Xd all = obstacles_.spheres();
  std::vector<int> some;
  for (int k = comm->me; k < all.cols(); k += comm->nprocs) some.push_back(k);
  return all(Eigen::all, some);
}

/// `parts`: of the spheres that this rank has told of.
void FixPfv::deal_obstacles(const std::vector<int>& parts) {
  std::vector<double> of_all(static_cast<std::size_t>(obstacles_.spheres().cols()), 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i) of_all[comm->me + i * comm->nprocs] = parts[i];
  ranks_.add(of_all.data(), static_cast<int>(of_all.size()));
  obstacles_.deal({of_all.begin(), of_all.end()}, comm->me);
}

/// Known to all, or of this rank alone, which ends the others.
void FixPfv::fail_on_flow(const std::exception& problem) {
  if (pfv::failed_together(*ranks_.library())) {
    const auto* error_of_library = dynamic_cast<const pfv::Error*>(&problem);
    const bool drawn = settings_.culprits && error_of_library;
    const pfv::PackingArrays named = drawn ? grains_named(error_of_library->culprits().spheres) : pfv::PackingArrays{};
    stop(FLERR, with_culprits(problem, named.view()));
  }
  if (!ranks_.is_first()) std::this_thread::sleep_for(std::chrono::seconds(1));  // the first one's text stands first
  const std::string message = "Fix pfv (id " + std::string(id) + "): " + units().relabelled(problem.what());
  error->one(FLERR, message.c_str());
}

/// Those of all ranks, on rank 0.
pfv::PackingArrays FixPfv::grains_named(const std::vector<std::int64_t>& tags) const {
  constexpr int width = 5;
  const pfv::Packing packing = grains_.packing();
  std::vector<double> rows;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    if (std::find(tags.begin(), tags.end(), packing.ids[k]) == tags.end()) continue;
    rows.push_back(static_cast<double>(packing.ids[k]));
    rows.insert(rows.end(), packing.positions.col(k).begin(), packing.positions.col(k).end());
    rows.push_back(packing.radii[k]);
  }
  const std::vector<double> all = ranks_.gathered(rows);
  const Eigen::Map<const Eigen::MatrixXd> columns(all.data(), width, static_cast<Eigen::Index>(all.size()) / width);
  pfv::PackingArrays named;
  named.ids = columns.row(0).cast<std::int64_t>();
  named.positions = columns.middleRows<3>(1);
  named.radii = columns.row(4);
  return named;
}

}  // namespace LAMMPS_NS
