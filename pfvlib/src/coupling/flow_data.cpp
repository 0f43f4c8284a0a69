// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "coupling/phase_clock.hpp"
#include "coupling/pore_strain.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

const Forces& FlowData::compute(const Packing& packing, double step, bool advance,
                                Coupling coupling, const GrainDynamics* grains) {
  if (fluid.bulk_modulus && !(step > 0.0))
    throw InputError("a compressible fluid needs a time step > 0");
  const double wall_start = wall_seconds();
  {
    const PhaseClock clock(seconds.total);
    if (!solved) stale = true;  // after a failure the network may be no longer that of the grains
    solved = false;
    balance_.reset();
    swept = advance && coupling == Coupling::explicit_step ? swept_volume(step) : 0.0;
    update_network(packing, step, advance);
    if (options.buoyancy && !fluid.gravity.isZero(0.0)) {
      displaced.resize(built->grains.spheres.size());
      for (Eigen::Index i = 0; i < displaced.size(); ++i)
        displaced[i] = displaced_volume(packing, built->grains.columns[i]);
    }
    factor_pressures(*built, build_settings(), step, {counts, seconds});
    counts.pinned_pores = 0;
    for (const Isolated& isolated : built->system.isolated)
      counts.pinned_pores += static_cast<std::int64_t>(isolated.pores.size());
    stages = 1;
    unpaid_growth = 0.0;
    debt_rate = step > 0.0 ? volume_debt / step : 0.0;
    solved_implicitly = coupling == Coupling::implicit;
    // velocities are those of the step that has ended, or that long steps are about to take
    measure_grown_areas(coupling == Coupling::explicit_step ? -0.5 * step : 0.5 * step);
    refuse_geometric(coupling);
    refuse_shear_forces(coupling);
    refuse_lag(coupling);
    const double at_time = advance ? time + step : time;
    if (coupling == Coupling::implicit) {
      run_implicit(packing, step, at_time, *grains);
    } else {
      update_rates(packing);
      if (coupling == Coupling::staged)
        run_stages(packing, step, at_time, *grains);
      else
        solve_pressures(at_time, *built->solver);
    }
    if (options.forces) compute_forces(packing);
    dt = step;
    solved_box = box;
    solved = true;
    if (advance) end_step(step);
  }
  wall_total += wall_seconds() - wall_start;
  return forces;
}

void FlowData::end_step(double step) {
  time += step;
  volume_debt = unpaid_growth;
  account.came_in += step * rates.sum();
  account.ahead = stages > 1 || solved_implicitly ? step * rates.sum() : 0.0;
  if (built->storage.size() > 0)
    account.came_in += step * built->storage.dot(pressures - previous_pressures);
  add_strain(step);
  if (fluid.bulk_modulus) old_pressures = pressures;
}

void FlowData::require_result() const {
  if (!solved)
    throw InputError("Flow holds no result: call step() or evaluate() first (the last call failed, "
                     "or there was none)");
}

/// Sees to a network of the grains as they are or, with rebuild_lag, as they were not long ago.
/// Only an advancing step begins a network in the background or takes it up, so that when that
/// happens depends on nothing but the steps.
void FlowData::update_network(const Packing& packing, double step, bool advance) {
  if (is_outdated(packing)) return rebuild_now(packing);
  if (advance && next && --steps_to_next == 0) {
    take_up_next();
    if (is_outdated(packing)) return rebuild_now(packing);
  }
  if (next || strain < options.retriangulation_strain) return;
  if (options.rebuild_lag == 0)
    rebuild_now(packing);
  else if (advance)
    begin_next(packing, step);
}

void FlowData::rebuild_now(const Packing& packing) {
  next.reset();
  stale = true;
  std::unique_ptr<LinearSolver> solver = built ? std::move(built->solver) : nullptr;
  if (built) former_grains = built->grains.spheres;
  if (old_pressures.size() == 0) built.reset();  // its memory is the new one's
  auto fresh = derive_network(packing, build_settings(), {counts, seconds});
  fresh->former_solver = std::move(solver);
  packing_ids.assign(packing.ids.data(), packing.ids.data() + packing.size());
  take_up(std::move(fresh));
  stale = moved_by_host = false;
  strain = strain_taken_over = 0.0;
}

void FlowData::refuse_lag(Coupling coupling) const {
  if (options.rebuild_lag > 0 && coupling == Coupling::implicit)
    throw InputError("the implicit coupling factors a matrix with the masses of the grains, which is "
                     "not done in the background: set rebuild_lag to 0, or take the staged coupling");
}

void FlowData::begin_next(const Packing& packing, double step) {
  next.emplace(packing, build_settings(), step, moving);
  steps_to_next = options.rebuild_lag;
  strain_before_next = strain;
  changes_before_next = volume_changes;
}

void FlowData::take_up_next() {
  const double start = wall_seconds();
  std::unique_ptr<BuiltNetwork> fresh = next->take({counts, seconds});
  if (fresh->solver) fresh->solver->share_with(team);
  wall_waited += wall_seconds() - start;
  next.reset();
  former_grains = built->grains.spheres;
  strain = changes_before_next.size() > 0 ? mean_strain(volume_changes - changes_before_next)
                                          : strain - strain_before_next;
  strain_taken_over = strain;
  take_up(std::move(fresh));
}

/// Carries over the pressures of a compressible fluid.
void FlowData::take_up(std::unique_ptr<BuiltNetwork> fresh) {
  const std::unique_ptr<BuiltNetwork> old = std::move(built);
  built = std::move(fresh);
  const int pores = built->network.pores();
  if (static_cast<int>(pending_pressures.size()) == pores && pores > 0)
    old_pressures = Eigen::Map<const Eigen::VectorXd>(pending_pressures.data(), pores);
  else if (old && old_pressures.size() > 0 && old_pressures.size() == old->network.pores())
    old_pressures = carried_pressures(*old, old_pressures, *built);
  else
    old_pressures.resize(0);
  pending_pressures.clear();
  if (fluid.bulk_modulus && old_pressures.size() == 0) old_pressures.setZero(pores);
  settle_account(former_grains ? &*former_grains : nullptr, swept);
  former_grains.reset();
  if (options.strain_measure == StrainMeasure::mean) volume_changes.setZero(pores);
  solution.setZero(built->unknowns.count);  // no trace of the old network in what follows
  counts.degenerate_throats = built->conductances.degenerate;
  counts.merged_pores = built->network.cells() - pores;
  if (had_network) ++retriangulations;
  had_network = true;
}

/// Whether the grains or the boundaries are others than those of the network, whatever the strain.
bool FlowData::is_outdated(const Packing& packing) const {
  if (stale || !built) return true;
  if (packing.size() != static_cast<Eigen::Index>(packing_ids.size()) ||
      !std::equal(packing_ids.begin(), packing_ids.end(), packing.ids.data()))
    return true;
  const ActiveGrains& grains = built->grains;
  std::size_t next = 0;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const bool active = next < grains.columns.size() && grains.columns[next] == k;
    if (is_inside(packing, k, box) != active) return true;
    if (!active) continue;
    const auto i = static_cast<Eigen::Index>(next++);
    const double radius = grains.spheres.radii[i];
    const double grown = std::abs(packing.radii[k] - radius);
    Eigen::Vector3d moved = packing.positions.col(k) - built->network.origin -
                            grains.spheres.centres.col(i);
    for (int axis = 0; axis < 3; ++axis)  // the host may have wrapped it
      if (box.periodic[axis])
        moved[axis] = std::remainder(moved[axis], grains.spheres.edges[axis]);
    // negated, so that a number that is not finite leads to a rebuild, whose checks name it
    if (!(3.0 * grown <= options.retriangulation_strain * radius) ||
        !(moved.squaredNorm() <= radius * radius))
      return true;
  }
  return false;
}

/// Velocities and spins of the active grains and of the faces.
void FlowData::set_motion(const Packing& packing) {
  const std::vector<int>& columns = built->grains.columns;
  motion.setZero(6, static_cast<Eigen::Index>(columns.size()) + 6);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto own = motion.col(static_cast<Eigen::Index>(i));
    if (packing.velocities.cols() > 0) own.head<3>() = packing.velocities.col(columns[i]);
    if (options.torques && packing.angular_velocities.cols() > 0)
      own.tail<3>() = packing.angular_velocities.col(columns[i]);
  }
  set_faces(motion, box, built->network.origin);
}

void FlowData::update_rates(const Packing& packing) {
  moving = !at_rest(packing, box, options.torques);
  refuse_undetermined(moving);
  set_motion(packing);
  if (moving)
    find_rates(motion);
  else
    rates.setZero(built->network.pores());
  refuse_isolated(built->system.isolated);
}

void FlowData::find_rates(const Motion& of) {
  const PhaseClock clock(seconds.assemble);
  make_volume_rates(*built, options, *team, counts);
  ++counts.volume_rate;
  rates_of(*built, of, *team, rates);
  spread_over_pores(growth_beyond_rates(of) + debt_rate);
}

/// Fills in the imposed pressures, less their mean: with a large common pressure the balances would
/// lose its digits.
void FlowData::impose(double at_time) {
  const auto& pores = built->unknowns.imposed_pores;
  impose_pressures(built->network, built->boundaries, box, at_time, relative_pressures);
  const double first = pores.empty() ? 0.0 : relative_pressures[pores.front()];
  double sum = 0.0;  // of the differences: where all are equal, the reference is exact
  for (const int pore : pores) sum += relative_pressures[pore] - first;
  reference = pores.empty() ? 0.0 : first + sum / static_cast<double>(pores.size());
  for (const int pore : pores) relative_pressures[pore] -= reference;
}

/// Pressures for the present rates.
void FlowData::solve_pressures(double at_time, LinearSolver& solver) {
  const PhaseClock clock(seconds.solve);
  const std::vector<int>& unknown = built->unknowns.of_pore;
  relative_pressures.resize(built->network.pores());
  impose(at_time);
  sources = -rates;
  previous_pressures = old_pressures;
  if (built->storage.size() > 0)
    sources.array() += built->storage.array() * (old_pressures.array() - reference);
  if (!box.pressure_gradient.isZero(0.0))
    sources += gradient_sources(built->network, built->conductances.value, box.pressure_gradient);
  right_hand_side(built->system, built->unknowns, box, sources, relative_pressures, right_side);
  if (built->unknowns.count > 0) {
    solver.solve(right_side, solution);
    ++counts.solve;
  }
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) relative_pressures[static_cast<Eigen::Index>(p)] = solution[unknown[p]];
  pressures = relative_pressures.array() + reference;
  if (!pressures.allFinite())
    throw SolverError(solver.name() +
                      " returned pressures that are not finite; the conductances span too many "
                      "orders of magnitude or the imposed values are too large");
  if (&solver == built->solver.get()) refine_pressures(solver, built->loses_digits, [] {});
}

Eigen::Vector3d FlowData::buoyancy_of(int sphere) const {
  return -fluid.density * displaced[sphere] * fluid.gravity;
}

/// What a macroscopic gradient adds to S p.
const Loads& FlowData::gradient_loads() {
  auto& kept = built->gradient_loads;
  if (!kept || kept->first != box.pressure_gradient)
    kept = {box.pressure_gradient,
            gradient_forces(built->network, built->vertices, built->throats, built->viscous_shares,
                            built->grains.spheres.size(),
                            {true, true, options.torques},
                            box.pressure_gradient)};
  return kept->second;
}

void FlowData::compute_forces(const Packing& packing) {
  const PhaseClock clock(seconds.forces);
  make_force_matrices(*built, options, *team, counts);
  const std::vector<int>& columns = built->grains.columns;
  const auto active = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index n = packing.size();
  const auto spread = [&](const auto& from, Eigen::Matrix3Xd& to) {
    to.resize(3, n);
    if (active < n) to.setZero();
    for (Eigen::Index i = 0; i < active; ++i) to.col(columns[i]) = from.col(i);
  };
  multiply(*built->force_matrix, relative_pressures, *team, loads);
  const bool driven = !box.pressure_gradient.isZero(0.0);
  if (driven) loads += gradient_loads();
  spread(loads.topRows<3>(), forces.total);
  if (options.torques) spread(loads.bottomRows<3>(), forces.torque);
  if (options.split_forces) {
    Loads of_pressure;
    multiply(*built->pressure_force_matrix, relative_pressures, *team, of_pressure);
    if (driven)
      of_pressure += gradient_forces(built->network, built->vertices, built->throats,
                                     built->viscous_shares, static_cast<int>(active),
                                     {true, false, false}, box.pressure_gradient);
    spread(of_pressure.topRows<3>(), forces.pressure);
    forces.viscous = forces.total - forces.pressure;
  }
  if (options.shear_viscous) add_shear_forces();
  if (options.buoyancy && !fluid.gravity.isZero(0.0)) {
    for (Eigen::Index i = 0; i < active; ++i) {
      const Eigen::Vector3d lift = buoyancy_of(static_cast<int>(i));
      forces.total.col(columns[i]) += lift;
      if (options.split_forces) forces.pressure.col(columns[i]) += lift;
    }
  }
  if (options.sphere_pressure) {
    multiply(*built->surface_pressure, pressures, *team, mean_pressures);
    if (!box.pressure_gradient.isZero(0.0))
      mean_pressures -= built->surface_pressure->offset.transpose() * box.pressure_gradient;
    forces.sphere_pressure.setZero(n);
    for (Eigen::Index i = 0; i < active; ++i) forces.sphere_pressure[columns[i]] = mean_pressures[i];
  }
}

void FlowData::add_strain(double step) {
  if (!moving || built->network.pores() == 0) return;
  if (options.strain_measure == StrainMeasure::mean) {
    volume_changes += step * rates;
    strain = strain_taken_over + mean_strain(volume_changes);
    return;
  }
  const Eigen::Map<const Eigen::ArrayXd> volumes(built->strain_volume.data(), rates.size());
  strain += (rates.array().abs() / volumes).maxCoeff() * step;
}

double FlowData::mean_strain(const Eigen::VectorXd& changes) const {
  return mean_pore_strain(built->network, built->conductances, relative_pressures, box.pressure_gradient,
                          changes, built->strain_volume);
}

}  // namespace pfv
