// SPDX-License-Identifier: GPL-3.0-or-later
// `couple_every auto`: at which steps the flow is solved, and what acts between.
#include "fix_pfv.h"

#include "atom.h"
#include "comm.h"
#include "update.h"

#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace LAMMPS_NS {

/// Whether the interval is the flow's own choice.
bool FixPfv::adapts() const { return settings_.steps.couple_error.has_value(); }

bool FixPfv::solve_due() {
  if (!adapts()) return steps_since_flow_ >= settings_.steps.couple_every;
  return steps_since_flow_ >= plan_.steps || imposed_values_changed() || grains_jumped();
}

/// Variables may change a boundary at any step; a change beyond the tolerance is solved for at once.
bool FixPfv::imposed_values_changed() {
  if (settings_.bindings.empty()) return false;
  const pfv::Box now = current_box();
  double change = 0.0, largest = 0.0;
  const auto compare = [&](const pfv::Boundary& a, const pfv::Boundary& b) {
    change = std::max(change, std::abs(a.value - b.value));
    largest = std::max({largest, std::abs(a.value), std::abs(b.value)});
    if (a.profile && b.profile)  // a cosine: its two extremes tell mean and amplitude
      for (const auto& place : {box_.lower, box_.upper})
        change = std::max(change, std::abs(a.profile(place, 0.0) - b.profile(place, 0.0)));
  };
  for (int f = 0; f < 6; ++f) compare(now.faces[f].boundary, box_.faces[f].boundary);
  for (std::size_t i = 0; i < now.patches.size(); ++i)
    compare(now.patches[i].boundary, box_.patches[i].boundary);
  for (std::size_t i = 0; i < now.regions.size(); ++i)
    compare(now.regions[i].boundary, box_.regions[i].boundary);
  return change > settings_.steps.couple_error.value() * largest;
}

/// Sum of |v| r² of the flow's grains, m³/s; collective.
double FixPfv::gross_motion() const {
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const double* v = atom->v[i];
      sum += std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * atom->radius[i] * atom->radius[i];
    }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

/// Whether the grains move so much faster or slower than at the last solve that the interval, which was made
/// from what had happened before, cannot have foreseen it: by what the loads have changed with the motion lately.
bool FixPfv::grains_jumped() {
  constexpr double foreseen = 10.0;  // tolerances
  if (steps_since_flow_ < 2) return false;
  const double change = std::abs(gross_motion() - plan_.gross_motion);
  return change * plan_.sensitivity > foreseen * settings_.steps.couple_error.value() * plan_.gross_motion;
}

/// Updates how much the loads change, over the load, when the motion of the grains changes by all of itself: as
/// much as the fluid's loads are at most, and at first; it fades as long as changes of the motion have led to
/// smaller ones of the loads, as in a steady flow through grains that creep. Rank 0.
void FixPfv::update_sensitivity(double motion) {
  constexpr double fading = 0.9;
  const double share = interval_->share_of_fluid(), before = plan_.gross_motion;
  plan_.gross_motion = motion;
  const double change = std::abs(motion - before);
  const bool seen = plan_.solved && change > settings_.steps.couple_error.value() * before;
  plan_.sensitivity = !plan_.solved ? share
                      : std::min(share, std::max(fading * plan_.sensitivity,
                                                 seen ? interval_->change() * before / change : 0.0));
  plan_.solved = true;
}

/// Steps over which loads can be held at most: within the limit of the explicit coupling, until the strain asks
/// for a new network if it goes on as in the `steps` since the last solve, and one with a compressible fluid,
/// whose held pressure drives grains and pistons like a spring with negative damping.
int FixPfv::most_steps(int steps) {
  constexpr double part_of_limit = 0.7;
  constexpr std::int64_t networks_for_a_limit = 4;
  if (settings_.fluid.bulk_modulus) return 1;
  if (plan_.limit < 0.0 || flow_->retriangulations() - plan_.networks >= networks_for_a_limit) {
    plan_.limit = time_step_limit();
    plan_.networks = flow_->retriangulations();
  }
  const double strain = std::abs(flow_->strain() - plan_.strain);
  double most = part_of_limit * plan_.limit / update->dt;
  if (strain > 0.0) most = std::min(most, settings_.options.retriangulation_strain / strain * steps);
  return static_cast<int>(std::clamp(most, 1.0, 1e6));
}

/// The largest load on a face beside the fluid's that is known: what grains press on meshes, or all of their
/// weight, N. Rank 0; `on_meshes` from all ranks.
double FixPfv::load_beside_fluid(double on_meshes) const {
  const Eigen::Vector3d g = settings_.fluid.gravity;
  double weight = 0.0;
  const Eigen::VectorXd& masses = grains_.masses();
  const auto radii = grains_.packing().radii;
  for (Eigen::Index k = 0; k < masses.size(); ++k)
    if (std::isfinite(masses[k]))
      weight += g.norm() * std::max(0.0, masses[k] - 4.0 / 3.0 * M_PI * std::pow(radii[k], 3) *
                                                       settings_.fluid.density);
  return std::max(on_meshes, weight);
}

/// Where this solve has brought the strain to its limit, the network is built anew at once and the loads are
/// those on the new one, not at the next solve: the difference between two solves then is the change in time
/// alone, and the network is not an interval older than was asked for. It costs one solve more. Rank 0.
bool FixPfv::take_up_new_network(int steps) {
  if (settings_.fluid.bulk_modulus ||
      flow_->strain() < settings_.options.retriangulation_strain)
    return false;
  flow_->evaluate(grains_.packing(), steps * update->dt);
  return true;
}

/// Decides on the next solve from the loads of this one, `steps` after the last; collective.
void FixPfv::plan_next_solve(int steps) {
  const double on_meshes = faces_.largest_load();
  const double motion = gross_motion();
  double told[3] = {1.0, 0.0, 0.0};
  on_root([&] {
    const auto radii = grains_.packing().radii;
    if (radii.size() == 0) return;
    const double section = M_PI * radii.squaredNorm() / static_cast<double>(radii.size());
    double area = 0.0;
    for (const pfv::Face face : pfv::all_faces) area = std::max(area, box_.area(face));
    const bool new_network = flow_->retriangulations() != plan_.last_network;
    plan_.last_network = flow_->retriangulations();
    interval_->take(grains_.packing().ids, flow_->forces(), flow_->face_forces(), steps,
                    load_beside_fluid(on_meshes), area, section, most_steps(steps), new_network);
    if (take_up_new_network(steps)) {
      plan_.last_network = flow_->retriangulations();
      interval_->put_on_network(flow_->forces(), flow_->face_forces());
    }
    plan_.strain = flow_->strain();
    update_sensitivity(motion);
    told[0] = interval_->steps();
    told[1] = interval_->held().offset;
    told[2] = plan_.sensitivity;
  });
  MPI_Bcast(told, 3, MPI_DOUBLE, 0, world);
  plan_.gross_motion = motion;
  plan_.steps = static_cast<int>(told[0]);
  plan_.offset = told[1];
  plan_.sensitivity = told[2];
}

/// At the setup of a run, with the loads of its evaluation; collective. What an earlier run saw is forgotten, as
/// it would be in one that starts from a restart file.
void FixPfv::begin_plan() {
  if (adapts()) plan_next_solve(1);
}

/// Steps from the instant that the loads of the last solve belong to until now; 0 where they are held.
double FixPfv::steps_of_trend() const {
  return adapts() && plan_.steps > 1 ? plan_.offset + steps_since_flow_ : 0.0;
}

}  // namespace LAMMPS_NS
