// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/network_keeper.hpp"

#include "physics/pore_strain.hpp"
#include "work/phase_clock.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

double mean_strain(const BuiltNetwork& built, const Solution& solution,
                   const Eigen::VectorXd& changes) {
  return mean_pore_strain(built.network, built.conductances, solution.relative_pressures,
                          solution.container.pressure_gradient, changes, built.strain_volume, built.share);
}

}  // namespace

void PoreStrain::begin(StrainMeasure measure, int pores, double taken_over) {
  measure_ = measure;
  value_ = taken_over_ = taken_over;
  volume_changes_.setZero(measure == StrainMeasure::mean ? pores : 0);
}

void PoreStrain::add(const BuiltNetwork& built, const Solution& solution) {
  const Eigen::VectorXd& rates = solution.rates;
  const double step = solution.dt;
  if (rates.size() == 0 && !built.share.ranks) return;
  if (measure_ == StrainMeasure::mean) {
    volume_changes_ += step * rates;
    value_ = taken_over_ + mean_strain(built, solution, volume_changes_);
    return;
  }
  const Eigen::Map<const Eigen::ArrayXd> volumes(built.strain_volume.data(), rates.size());
  const double largest = rates.size() > 0 ? (rates.array().abs() / volumes).maxCoeff() : 0.0;
  value_ += built.share.largest(largest) * step;
}

double PoreStrain::since(const PoreStrain& then, const BuiltNetwork& built,
                         const Solution& last) const {
  if (then.measure_ == StrainMeasure::mean)
    return mean_strain(built, last, volume_changes_ - then.volume_changes_);
  return value_ - then.value_;
}

BuiltNetwork& NetworkKeeper::update(const Packing& packing, const Problem& problem,
                                    const Wanted& wanted, WorkRecord& work,
                                    const TakenUp& taken_up) {
  if (!stale_ && built_ && built_->share.any(has_jumped(problem, wanted))) discard(true);
  if (!stale_ && built_ && built_->share.any(grains_have_jumped(packing, problem, wanted))) discard(false);
  const bool kept = !stale_ && built_;
  const std::int64_t before = rebuilds_;
  BuiltNetwork& built = renew(packing, problem, wanted, work, taken_up);
  if (wanted.advance && kept) jumps_.pass(problem.container, wanted.step);
  if (wanted.advance || !kept || rebuilds_ != before) grain_jumps_.pass(packing, wanted.step);
  return built;
}

BuiltNetwork& NetworkKeeper::renew(const Packing& packing, const Problem& problem, const Wanted& wanted,
                                   WorkRecord& work, const TakenUp& taken_up) {
  const auto anew = [&] { rebuild_now(packing, problem, wanted, work, taken_up); };
  if (is_outdated(packing, problem)) {
    anew();
    return *built_;
  }
  if (wanted.advance && next_ && --next_->steps == 0) {
    take_up_next(problem, wanted.last, work, taken_up);
    if (is_outdated(packing, problem)) {
      anew();
      return *built_;
    }
  }
  if (next_ || strain_.value() < problem.options.retriangulation_strain) return *built_;
  if (problem.options.rebuild_lag == 0)
    anew();
  else if (wanted.advance)
    next_.emplace(Next{BackgroundRebuild(packing, problem, wanted.step, wanted.last.moving),
                       problem.options.rebuild_lag, strain_});
  return *built_;
}

void NetworkKeeper::discard(bool by_host) {
  stale_ = true;
  moved_by_host_ = moved_by_host_ || by_host;
}

void NetworkKeeper::restore(double strain, std::int64_t rebuilds) {
  discard(false);
  built_.reset();
  next_.reset();
  former_grains_.reset();
  had_network_ = false;
  strain_.restore(strain);
  rebuilds_ = rebuilds;
}

void NetworkKeeper::rebuild_now(const Packing& packing, const Problem& problem,
                                const Wanted& wanted, WorkRecord& work, const TakenUp& taken_up) {
  next_.reset();
  stale_ = true;
  std::unique_ptr<LinearSolver> solver = built_ ? std::move(built_->kept.solver) : nullptr;
  if (built_) former_grains_ = own_grains(*built_);
  if (!wanted.keep_former) built_.reset();  // its memory is the new one's
  auto fresh = derive_network(packing, problem, work);
  fresh->kept.former_solver = std::move(solver);
  ids_.assign(packing.ids.data(), packing.ids.data() + packing.size());
  jumps_.begin(problem.container, wanted.step);
  take_up(std::move(fresh), problem, 0.0, work, taken_up);
  stale_ = moved_by_host_ = false;
}

void NetworkKeeper::take_up_next(const Problem& problem, const Solution& last, WorkRecord& work,
                                 const TakenUp& taken_up) {
  const double start = wall_seconds();
  std::unique_ptr<BuiltNetwork> fresh = next_->network.take(work);
  if (fresh->kept.solver) fresh->kept.solver->share_with(problem.team);
  work.wall_seconds.waited += wall_seconds() - start;
  const double strain = strain_.since(next_->begun_at, *built_, last);
  next_.reset();
  former_grains_ = own_grains(*built_);
  take_up(std::move(fresh), problem, strain, work, taken_up);
}

void NetworkKeeper::take_up(std::unique_ptr<BuiltNetwork> fresh, const Problem& problem,
                            double strain, WorkRecord& work, const TakenUp& taken_up) {
  Replaced replaced{std::move(built_), std::move(former_grains_), moved_by_host_, jumps_.volume_put(problem.container)};
  former_grains_.reset();
  built_ = std::move(fresh);
  const int pores = built_->network.pores();
  strain_.begin(problem.options.strain_measure, pores, strain);
  work.counts.degenerate_throats = degenerate_throats(*built_);
  work.counts.merged_pores = merged_pores(*built_);
  work.counts.enclosed_pores = built_->closed.enclosed;
  work.counts.joined_pores = built_->closed.joined;
  if (had_network_) ++rebuilds_;
  had_network_ = true;
  taken_up(std::move(replaced));
}

/// Whether the grains or the boundaries are others than those of the network, whatever the strain. Where several ranks
/// share it, all come to one answer, and the ghosts are brought up to date.
bool NetworkKeeper::is_outdated(const Packing& packing, const Problem& problem) {
  if (stale_ || !built_) return true;
  const bool others = !holds_the_same(built_->grains, packing) ||
                      !same_grains(packing, problem.container, ids_, built_->grains.columns);
  if (built_->share.any(others)) return true;
  if (built_->halo) built_->halo->refresh(packing);
  return built_->share.any(has_moved_far(built_->halo ? built_->halo->seen() : packing, problem));
}

/// Over steps pores follow a face as they do a grain, by the radius of the smallest; without a step the faces count as
/// they are, up to the strain that is allowed.
bool NetworkKeeper::has_jumped(const Problem& problem, const Wanted& wanted) const {
  const Eigen::VectorXd& radii = built_->grains.spheres.radii;
  if (radii.size() == 0) return false;
  const double smallest = radii.minCoeff(), strain = std::min(1.0, problem.options.retriangulation_strain);
  return jumps_.any(problem.container, wanted.step, wanted.advance ? smallest : strain * smallest, smallest);
}

/// A look at grains that are elsewhere, or a step in which they come to be there without a velocity.
bool NetworkKeeper::grains_have_jumped(const Packing& packing, const Problem& problem, const Wanted& wanted) const {
  const ActiveGrains& grains = built_->grains;
  return packing.size() == packed() && std::equal(ids_.begin(), ids_.end(), packing.ids.data()) &&
         grain_jumps_.any(packing, grains.columns, grains.spheres.lattice(), wanted.advance ? wanted.step : 0.0,
                          std::min(1.0, problem.options.retriangulation_strain));
}

bool NetworkKeeper::has_moved_far(const Packing& packing, const Problem& problem) const {
  const ActiveGrains& grains = built_->grains;
  const double strain = problem.options.retriangulation_strain;
  for (Eigen::Index i = 0; i < grains.spheres.radii.size(); ++i) {
    const int k = grains.columns[i];
    const double radius = grains.spheres.radii[i];
    const double grown = std::abs(packing.radii[k] - radius);
    Eigen::Vector3d moved = packing.positions.col(k) - built_->network.origin -
                            grains.spheres.centres.col(i);
    if (!problem.container.tilt.isZero(0.0)) {
      const Lattice lattice = grains.spheres.lattice();
      moved -= lattice.displacement(lattice.nearest(moved));
    }
    for (int axis = 0; axis < 3; ++axis)  // the host may have wrapped it
      if (problem.container.periodic[axis])
        moved[axis] = std::remainder(moved[axis], grains.spheres.edges[axis]);
    // negated, so that a number that is not finite leads to a rebuild, whose checks name it
    if (!(3.0 * grown <= strain * radius) || !(moved.squaredNorm() <= radius * radius))
      return true;
  }
  return false;
}

}  // namespace pfv
